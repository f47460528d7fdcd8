#pragma once
#include <string>
#include <vector>

namespace thixis::output {

/// An entry of the outermost group of an HDF5 file that is found under the same name in another file.
struct Link {
  std::string name;  ///< of the group, with its '/'
  std::string file;  ///< relative to the file with the link
};

/// The bytes of an HDF5 file that holds nothing but external links. Not collective. Throws an Error with code `internal`.
std::string file_of_links(const std::vector<Link>& links);

}  // namespace thixis::output
