#pragma once
#include <string>
#include <vector>

#include "thixis/core/comm.hpp"
#include "thixis/core/deck.hpp"
#include "thixis/core/error.hpp"

namespace thixis {

/// What the command line says besides the command.
struct Arguments {
  std::string deck, output, block;
  std::vector<std::string> overrides;
  bool quiet = false, verbose = false;
  core::Format format = core::Format::text;
};

using Command = core::ExitCode (*)(const Arguments&, const core::Comm&);

/// What the program does.
struct Commands {
  Command run, restart, check, describe, cases;
};

/// Parses the command line and does what it says. Throws InputError where it says nothing that can be done.
core::ExitCode obey(int argc, char** argv, const Commands& commands, const core::Comm& comm);

}  // namespace thixis
