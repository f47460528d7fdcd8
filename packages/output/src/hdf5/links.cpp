#include "hdf5/links.hpp"

#include "hdf5/hdf5_handle.hpp"
#include "thixis/core/error.hpp"

namespace thixis::output {
namespace {

void require(bool done) {
  if (!done) throw core::Error(core::ExitCode::internal, "HDF5 can not make a file of links in memory.");
}

}  // namespace

std::string file_of_links(const std::vector<Link>& links) {
  const Quiet quiet;
  // In memory: then it is written as any other bytes, and a full disk is no concern of HDF5.
  constexpr std::size_t growth = 1u << 16;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access, growth, false);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  const Handle file(H5Fcreate("links", H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
  require(file.valid());
  for (const Link& link : links)
    require(H5Lcreate_external(link.file.c_str(), link.name.c_str(), file, link.name.c_str(), H5P_DEFAULT, H5P_DEFAULT) >= 0);
  require(H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0);
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  require(size > 0);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  require(H5Fget_file_image(file, bytes.data(), bytes.size()) == size);
  return bytes;
}

}  // namespace thixis::output
