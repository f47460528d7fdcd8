#include "hdf5/hdf5_reader.hpp"

#include <array>

#include "hdf5/hdf5_handle.hpp"
#include "thixis/core/error.hpp"

namespace thixis::output {
namespace {

/// All names in alphabetical order. `name_at(k, text, size)` gives the k-th one as HDF5 does: its length, negative behind the last one.
template <class NameAt>
std::vector<std::string> names(NameAt name_at) {
  std::vector<std::string> found;
  for (hsize_t k = 0;; ++k) {
    const ssize_t length = name_at(k, nullptr, 0);
    if (length < 0) return found;
    std::string name(length + 1, '\0');
    name_at(k, name.data(), name.size());
    name.pop_back();
    found.push_back(name);
  }
}

}  // namespace

Hdf5Reader::Hdf5Reader(const std::string& path, std::string complaint) : complaint_(std::move(complaint)) {
  const Quiet quiet;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  H5Pset_file_locking(access, false, true);
  file_ = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
  require(file_ >= 0);
  hsize_t bytes = 0;
  require(H5Fget_filesize(file_, &bytes) >= 0);
  bytes_ = static_cast<GlobalIndex>(bytes);
}

Hdf5Reader::~Hdf5Reader() {
  const Quiet quiet;
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5Reader::require(bool good) const {
  if (!good) throw core::FileError(complaint_);
}

/// Every step of the way to an entry is an entry itself.
void Hdf5Reader::require_own(const std::string& name) const {
  for (std::size_t end = name.find('/', 1);; end = name.find('/', end + 1)) {
    const std::string part = name.substr(0, end);
    H5L_info_t info{};
    require(part == "/" || (H5Lget_info(file_, part.c_str(), &info, H5P_DEFAULT) >= 0 && info.type == H5L_TYPE_HARD));
    if (end == std::string::npos) return;
  }
}

/// What the values of an array take in memory: they stand in this file, one after the other.
GlobalIndex Hdf5Reader::bytes_of(Id array) const {
  const Handle creation(H5Dget_create_plist(array), H5Pclose), type(H5Dget_type(array), H5Tclose), space(H5Dget_space(array), H5Sclose);
  require(H5Pget_layout(creation) == H5D_CONTIGUOUS && H5Pget_external_count(creation) == 0);
  const auto points = static_cast<GlobalIndex>(H5Sget_simple_extent_npoints(space)), size = static_cast<GlobalIndex>(H5Tget_size(type));
  require(points >= 0 && size > 0 && points <= bytes_ / size);
  return points * size;
}

bool Hdf5Reader::has(const std::string& name) const {
  const Quiet quiet;
  return H5Lexists(file_, name.c_str(), H5P_DEFAULT) > 0;
}

std::string Hdf5Reader::text(const std::string& name) const {
  const Quiet quiet;
  require_own(name);
  const Handle array(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  require(array.valid());
  const Handle type(H5Dget_type(array), H5Tclose), space(H5Dget_space(array), H5Sclose);
  require(H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 && H5Sget_simple_extent_npoints(space) == 1);
  std::string text(bytes_of(array), '\0');
  require(H5Dread(array, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) >= 0);
  return text.substr(0, text.find('\0'));
}

void Hdf5Reader::read_attribute(const std::string& group, const std::string& name, Id type, void* value) const {
  const Quiet quiet;
  require_own(group);
  const Handle attribute(H5Aopen_by_name(file_, group.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  require(attribute.valid());
  const Handle stored(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
  require(H5Tget_class(stored) == H5Tget_class(type) && H5Sget_simple_extent_npoints(space) == 1 && H5Aread(attribute, type, value) >= 0);
}

double Hdf5Reader::number(const std::string& group, const std::string& name) const {
  double value = 0;
  read_attribute(group, name, H5T_NATIVE_DOUBLE, &value);
  return value;
}
GlobalIndex Hdf5Reader::integer(const std::string& group, const std::string& name) const {
  GlobalIndex value = 0;
  read_attribute(group, name, H5T_NATIVE_LLONG, &value);
  return value;
}

std::vector<std::string> Hdf5Reader::attributes(const std::string& group) const {
  const Quiet quiet;
  require_own(group);
  const Handle place(H5Gopen2(file_, group.c_str(), H5P_DEFAULT), H5Gclose);
  require(place.valid());
  return names([&](hsize_t k, char* name, std::size_t size) {
    return H5Aget_name_by_idx(place, ".", H5_INDEX_NAME, H5_ITER_INC, k, name, size, H5P_DEFAULT);
  });
}

std::vector<std::string> Hdf5Reader::entries(const std::string& group) const {
  const Quiet quiet;
  require_own(group);
  const Handle place(H5Gopen2(file_, group.c_str(), H5P_DEFAULT), H5Gclose);
  require(place.valid());
  return names([&](hsize_t k, char* name, std::size_t size) {
    return H5Lget_name_by_idx(place, ".", H5_INDEX_NAME, H5_ITER_INC, k, name, size, H5P_DEFAULT);
  });
}

GlobalIndex Hdf5Reader::rows(const std::string& array) const {
  const Quiet quiet;
  require_own(array);
  const Handle place(H5Dopen2(file_, array.c_str(), H5P_DEFAULT), H5Dclose);
  require(place.valid());
  const Handle space(H5Dget_space(place), H5Sclose);
  std::array<hsize_t, H5S_MAX_RANK> extents{};
  require(H5Sget_simple_extent_dims(space, extents.data(), nullptr) > 0);
  return static_cast<GlobalIndex>(extents[0]);
}

GlobalIndex Hdf5Reader::length(const std::string& vector) const {
  const Quiet quiet;
  require_own(vector);
  const Handle array(H5Dopen2(file_, vector.c_str(), H5P_DEFAULT), H5Dclose);
  require(array.valid());
  const Handle space(H5Dget_space(array), H5Sclose);
  require(H5Sget_simple_extent_ndims(space) == 1);
  bytes_of(array);
  return H5Sget_simple_extent_npoints(space);
}

void Hdf5Reader::read_rows(const std::string& vector, const Slab& slab, Id type, void* rows) const {
  if (slab.size == 0) return;
  const Quiet quiet;
  require_own(vector);
  const Handle array(H5Dopen2(file_, vector.c_str(), H5P_DEFAULT), H5Dclose);
  require(array.valid());
  const Handle stored(H5Dget_type(array), H5Tclose), space(H5Dget_space(array), H5Sclose);
  require(H5Tget_class(stored) == H5Tget_class(type));
  const auto begin = static_cast<hsize_t>(slab.begin), size = static_cast<hsize_t>(slab.size);
  const Handle memory(H5Screate_simple(1, &size, nullptr), H5Sclose);
  require(H5Sselect_hyperslab(space, H5S_SELECT_SET, &begin, nullptr, &size, nullptr) >= 0 &&
          H5Dread(array, type, memory, space, H5P_DEFAULT, rows) >= 0);
}

std::vector<double> Hdf5Reader::numbers(const std::string& vector, const Slab& slab) const {
  std::vector<double> rows(slab.size);
  read_rows(vector, slab, H5T_NATIVE_DOUBLE, rows.data());
  return rows;
}
std::vector<GlobalIndex> Hdf5Reader::integers(const std::string& vector, const Slab& slab) const {
  std::vector<GlobalIndex> rows(slab.size);
  read_rows(vector, slab, H5T_NATIVE_LLONG, rows.data());
  return rows;
}

}  // namespace thixis::output
