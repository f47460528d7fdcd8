#include "hdf5_file.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <hdf5.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "thixis/core/error.hpp"

#ifndef H5_HAVE_PARALLEL
#error "Thixis needs the parallel HDF5."
#endif

namespace thixis::output {
namespace {

static_assert(sizeof(hid_t) <= sizeof(long long));

/// HDF5 prints no error stacks while it lives.
class Quiet {
 public:
  Quiet() {
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Quiet() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

/// An identifier of HDF5 with the function that gives it back.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }
  bool valid() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Opens the file for the root alone and makes room at its end, which HDF5 cuts off again as far as it is not needed. Says what the system
/// says; MPI-IO would only say that it failed.
void make_room(const std::string& path, Hdf5File::Mode mode, long long room) {
  const bool create = mode == Hdf5File::Mode::create;
  const int file = ::open(path.c_str(), create ? O_CREAT | O_TRUNC | O_RDWR : O_RDWR, 0666);
  if (file < 0)
    throw core::FileError(fmt::format("The file '{}' can not be {}: {}.", path, create ? "created" : "opened", std::strerror(errno)));
  const off_t size = ::lseek(file, 0, SEEK_END);
  const int error = size < 0 ? errno : ::posix_fallocate(file, size, room);
  const bool refused = error == ENOSPC || error == EFBIG || error == EDQUOT || error == EIO;
  const bool restored = !refused || ::ftruncate(file, size) == 0;
  ::close(file);
  if (refused || !restored)
    throw core::FileError(fmt::format("The file '{}' can not grow by {:.3g} MB: {}.", path, 1e-6 * room, std::strerror(error)));
}

}  // namespace

Hdf5File::Hdf5File(const std::string& path, Mode mode, long long room, const core::Comm& comm) : path_(path), comm_(comm) {
  comm.on_root([&] { make_room(path, mode, room); });
  const Quiet quiet;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_mpio(access, comm.mpi(), MPI_INFO_NULL);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  H5Pset_coll_metadata_write(access, true);
  H5Pset_all_coll_metadata_ops(access, true);
  file_ = mode == Mode::create ? H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access) : H5Fopen(path.c_str(), H5F_ACC_RDWR, access);
  if (!comm.all(file_ >= 0)) {
    if (file_ >= 0) H5Fclose(file_);
    throw core::FileError(fmt::format("The file '{}' can not be opened by all ranks: its folder must be seen by all of them.", path));
  }
}

Hdf5File::~Hdf5File() {
  const Quiet quiet;
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5File::require(bool done, const std::string& what) const {
  if (comm_.all(done)) return;
  throw core::FileError(fmt::format("{} can not be written to '{}': there was an error of the disk or of the network.", what, path_));
}

void Hdf5File::add_group(const std::string& name) {
  const Quiet quiet;
  const Handle group(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  require(group.valid(), fmt::format("The group '{}'", name));
}

void Hdf5File::add_attribute(const std::string& group, const std::string& name, double value) {
  const Quiet quiet;
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(
      H5Acreate_by_name(file_, group.c_str(), name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  require(attribute.valid() && H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value) >= 0, fmt::format("The attribute '{}' of '{}'", name, group));
}

void Hdf5File::add_rows(const std::string& name, const Slab& slab, int columns, Id type, const void* rows) {
  const Quiet quiet;
  const int rank = columns == 1 ? 1 : 2;
  const auto width = static_cast<hsize_t>(columns);
  const std::array<hsize_t, 2> whole{static_cast<hsize_t>(slab.total), width}, begin{static_cast<hsize_t>(slab.begin), 0},
      piece{static_cast<hsize_t>(slab.size), width};
  const Handle file_space(H5Screate_simple(rank, whole.data(), nullptr), H5Sclose);
  const Handle memory_space(H5Screate_simple(rank, piece.data(), nullptr), H5Sclose);
  if (slab.size > 0) {
    H5Sselect_hyperslab(file_space, H5S_SELECT_SET, begin.data(), nullptr, piece.data(), nullptr);
  } else {
    H5Sselect_none(file_space);
    H5Sselect_none(memory_space);
  }

  // Every row is written, and equal data shall give equal files: neither fill values nor time stamps.
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
  H5Pset_obj_track_times(creation, false);
  const hid_t stored = H5Tequal(type, H5T_NATIVE_DOUBLE) > 0 ? H5T_IEEE_F64LE : H5T_STD_I64LE;
  const std::string what = fmt::format("The array '{}'", name);
  const Handle array(H5Dcreate2(file_, name.c_str(), stored, file_space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose);
  require(array.valid(), what);

  const Handle transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  H5Pset_dxpl_mpio(transfer, H5FD_MPIO_COLLECTIVE);
  require(H5Dwrite(array, type, memory_space, file_space, transfer, rows) >= 0, what);
}

void Hdf5File::add_array(const std::string& name, const Slab& slab, int columns, const std::vector<double>& rows) {
  add_rows(name, slab, columns, H5T_NATIVE_DOUBLE, rows.data());
}
void Hdf5File::add_array(const std::string& name, const Slab& slab, int columns, const std::vector<GlobalIndex>& rows) {
  add_rows(name, slab, columns, H5T_NATIVE_LLONG, rows.data());
}

void Hdf5File::close() {
  const Quiet quiet;
  const hid_t file = file_;
  file_ = -1;
  require(H5Fclose(file) >= 0, "The data");
}

}  // namespace thixis::output
