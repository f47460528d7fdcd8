#include "hdf5/hdf5_file.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>

#include "hdf5/hdf5_handle.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/file.hpp"

#ifndef H5_HAVE_PARALLEL
#error "Thixis needs the parallel HDF5."
#endif

namespace thixis::output {
namespace {

static_assert(sizeof(hid_t) <= sizeof(long long));

/// Opens the file for the root alone and makes room at its end, which HDF5 cuts off again as far as it is not needed. Says what the system
/// says; MPI-IO would only say that it failed.
void make_room(const std::string& path, Hdf5File::Mode mode, long long room) {
  const bool create = mode == Hdf5File::Mode::create;
  core::require_plain_place(path);
  const int file = ::open(path.c_str(), (create ? O_CREAT | O_TRUNC | O_RDWR : O_RDWR) | O_NOFOLLOW | O_CLOEXEC, 0666);
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

void check_entry_name(const std::string& what, const std::string& name) {
  bool valid = !name.empty() && name.front() != ' ' && name.back() != ' ' && name.front() != '.';
  for (const unsigned char c : name) valid = valid && (std::isalnum(c) || std::strchr("_-. ", c));
  if (!valid)
    throw core::Error(
        core::ExitCode::internal,
        fmt::format("A {} can not be called '{}': its name must be made of letters, digits, '_', '-', '.' and inner spaces.", what, name));
}

Hdf5File::Hdf5File(const std::string& path, Mode mode, long long room, const core::Comm& comm, std::size_t front)
    : path_(path), comm_(comm) {
  comm.on_root([&] { make_room(path, mode, room); });
  const Quiet quiet;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_mpio(access, comm.mpi(), MPI_INFO_NULL);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  // Not collectively: then ranks write pieces of metadata with gaps between them at once, and Open MPI 4.1 (ompio, fbtl/posix write data
  // sieving) fills gaps with what it has read before, over what another rank has written meanwhile.
  H5Pset_coll_metadata_write(access, false);
  H5Pset_all_coll_metadata_ops(access, true);
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_userblock(creation, front);
  file_ = mode == Mode::create ? H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access) : H5Fopen(path.c_str(), H5F_ACC_RDWR, access);
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

void Hdf5File::add_number(const std::string& group, const std::string& name, Id stored, Id type, const void* value) {
  const Quiet quiet;
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate_by_name(file_, group.c_str(), name.c_str(), stored, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  require(attribute.valid() && H5Awrite(attribute, type, value) >= 0, fmt::format("The attribute '{}' of '{}'", name, group));
}

void Hdf5File::add_attribute(const std::string& group, const std::string& name, double value) {
  add_number(group, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}
void Hdf5File::add_attribute(const std::string& group, const std::string& name, GlobalIndex value) {
  add_number(group, name, H5T_STD_I64LE, H5T_NATIVE_LLONG, &value);
}

void Hdf5File::add_text(const std::string& name, const std::string& text) {
  const Quiet quiet;
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose), creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Tset_size(type, text.size() + 1);
  H5Tset_cset(type, H5T_CSET_UTF8);
  H5Pset_obj_track_times(creation, false);
  const std::string what = fmt::format("The text '{}'", name);
  const Handle array(H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose);
  require(array.valid(), what);
  const Handle memory_space(H5Screate(H5S_SCALAR), H5Sclose);
  if (!comm_.root()) {
    H5Sselect_none(space);
    H5Sselect_none(memory_space);
  }
  const Handle transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  H5Pset_dxpl_mpio(transfer, H5FD_MPIO_COLLECTIVE);
  require(H5Dwrite(array, type, memory_space, space, transfer, text.c_str()) >= 0, what);
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
  if (slab.total == 0) return;  // HDF5 refuses to write nothing

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

void Hdf5File::sync() {
  const Quiet quiet;
  require(H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0, "The data");
}

void Hdf5File::close() {
  const Quiet quiet;
  const hid_t file = file_;
  file_ = -1;
  require(H5Fclose(file) >= 0, "The data");
}

}  // namespace thixis::output
