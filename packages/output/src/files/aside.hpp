#pragma once
#include <string>

#include "thixis/core/comm.hpp"

namespace thixis::output {

/// Gives a complete file the name of another one, which it replaces, and makes the new name last: a crash of the machine does not bring the
/// old file back. Throws FileError; not collective.
void move_into_place(const std::string& temporary, const std::string& path);
/// Removes a file that may be there. Not collective.
void discard(const std::string& path);

/// Writes the file `path` aside: write(temporary) makes the whole file beside its place (`<path>.part`), on the disk, and then it is
/// renamed. At any moment, also when the program is killed, the whole old or the whole new file is there. write is collective and throws an
/// Error on all ranks; then the old file stays. Collective.
template <class Write>
void write_aside(const std::string& path, const core::Comm& comm, Write&& write) {
  const std::string temporary = path + ".part";
  try {
    write(temporary);
  } catch (const core::Error&) {
    comm.on_root([&] { discard(temporary); });
    throw;
  }
  comm.on_root([&] { move_into_place(temporary, path); });
}

}  // namespace thixis::output
