#pragma once
#include <cstddef>
#include <string>

#include "thixis/core/file.hpp"

namespace thixis::output {

/// The seal of a file: a text of 512 bytes in front of its content, where HDF5 leaves room for one (the user block), that knows how long
/// the content is and a checksum of all of it. Nothing of a sealed file is believed, and no library sees it, before its seal is found
/// whole: a flipped bit among the data that HDF5 keeps for itself can end the program.
///
///     thixis checkpoint
///     format 2
///     bytes 34012
///     crc32 89abcdef           of the content and the line of the format (ISO 3309, as in zlib and gzip)
///
/// and zeros. CRC-32 finds every change within 32 bits in a row, and all others but one in 4e9. It tells damage, not forgery.
constexpr std::size_t seal_bytes = 512;

struct Seal {
  std::string kind;  ///< its first line
  int format;
};

/// Seals a file whose first 512 bytes are free, and brings them to the disk. Throws FileError. Not collective.
void write_seal(const std::string& path, const Seal& seal);

enum class SealState {
  whole,    ///< this kind and format, and every byte is the one that was sealed
  damaged,  ///< was of this kind once
  other_format,
  none
};
struct SealFound {
  SealState state;
  int format;  ///< of other_format
};
/// Reads the whole file. Throws FileError where the disk fails. Not collective.
SealFound look_at_seal(core::RegularFile& file, const Seal& wanted);

}  // namespace thixis::output
