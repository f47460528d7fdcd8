#pragma once
#include <exception>
#include <string>

#include "thixis/core/comm.hpp"

namespace thixis::core {

/// Largest resident set of this process so far, in MB (10^6 bytes).
double peak_memory_mb();

/// What the processes of this machine can use together, in MB: memory and swap space, or less where a control group (a container, a batch
/// job) allows less. Infinite where the system does not say.
double machine_memory_mb();
/// What this process can use by itself, in MB (ulimit -v); infinite without a limit.
double process_memory_mb();

/// Throws InputError if a run of all ranks that needs so many MB, in equal shares, has more than the memory of some machine that they are
/// on, or than their processes may have: "<path>: the run needs about ...". Collective.
void require_memory(double megabytes, const std::string& path, const Comm& comm);

/// What an exception of any library amounts to: the Error that it is; InputError where memory was not to be had, for the deck asks for more
/// than there is; code `internal` for all others. Errors that ranks throw together have gone through it.
Error as_error(const std::exception& caught);

}  // namespace thixis::core
