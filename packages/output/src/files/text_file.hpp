#pragma once
#include <string>

namespace thixis::output {

/// Writes a text file so that at any moment either the old or the new one is there (a temporary one beside it, then renamed). Throws
/// FileError; not collective.
void write_text(const std::string& path, const std::string& text);

/// "The file 'path' can not be written: <what the system says>."
std::string not_written(const std::string& path, int error_number);

}  // namespace thixis::output
