#pragma once
#include <csignal>
#include <string>

#include "thixis/core/comm.hpp"

namespace thixis::drive {

/// While it lives, SIGTERM (and SIGINT, Ctrl-C) do not end the process but are remembered, so that the run can end between two steps. A
/// second signal ends it as before.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// The signal that some rank has got, 0 if none has. Collective.
  static int asked(const core::Comm& comm);
  static std::string name(int signal);

 private:
  struct sigaction term_, interrupt_;
};

}  // namespace thixis::drive
