#include "thixis/output/fields.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "files/aside.hpp"
#include "files/text_file.hpp"
#include "frames.hpp"
#include "grid.hpp"
#include "hdf5/hdf5_file.hpp"
#include "hdf5/links.hpp"
#include "hdf5/slabs.hpp"
#include "seal.hpp"
#include "thixis/core/error.hpp"
#include "xdmf.hpp"

namespace thixis::output {
namespace {

const std::string data_name = "fields.h5";

/// Bytes that a grid needs in the file.
long long room_of(const XdmfGrid& grid, bool new_mesh) {
  long long room = group_bytes;
  if (new_mesh) room += group_bytes + 2 * array_bytes + 8 * (2 * grid.points + grid.corners * grid.cells);
  for (const XdmfAttribute& field : grid.attributes)
    room += array_bytes + 8 * field.columns * (field.centre == Centre::vertex ? grid.points : grid.cells);
  return room;
}

/// [cells][corners] ids of points.
std::vector<GlobalIndex> corner_ids(const Grid& grid, const Cells& cells) {
  std::vector<GlobalIndex> result(cells.points.size());
  std::transform(cells.points.begin(), cells.points.end(), result.begin(), [&](LocalIndex point) { return grid.point_id[point]; });
  return result;
}

}  // namespace

struct FieldWriter::Impl {
  std::string data_path, text_path;
  core::Comm comm;
  Frames frames;
  bool series;  ///< each grid in a file of its own
  bool open = true;
  int grids = 0, listed = 0;  ///< written so far, and how many of them the XDMF file lists
  struct {
    double time = 0;
    int mesh = 0;
    std::uint64_t fingerprint = 0;  ///< of the mesh
  } last;
  std::string single, collected;  ///< elements of the XDMF file, on the root
  std::vector<int> meshes;        ///< numbers of those written so far

  Impl(const std::string& folder, const core::Comm& on_comm, bool is_series)
      : data_path((std::filesystem::path(folder) / data_name).string()),
        text_path((std::filesystem::path(folder) / "fields.xdmf").string()),
        comm(on_comm),
        frames(folder),
        series(is_series) {}

  void begin_file() const {
    comm.on_root([&] { discard(text_path); });
    Hdf5File(data_path, Hdf5File::Mode::create, group_bytes, comm).close();
    comm.on_root([&] { frames.remove(); });
  }

  void begin_series(int frames_kept) {
    comm.on_root([&] {
      frames.make_folder();
      for (int n = 0; n < frames_kept; ++n) take_in(n);
      // First the files that refer to frames: at any moment they name only those that are there.
      write_list();
      frames.remove_from(grids);
    });
    comm.broadcast(last);
    comm.broadcast(meshes);
    comm.broadcast(grids);
    listed = grids;
  }

  /// The next frame of an interrupted run, on the root.
  void take_in(int n) {
    StoredFrame stored = frames.read(n, last.mesh);
    if (stored.mesh == n) {
      last.fingerprint = stored.fingerprint;
      meshes.push_back(n);
    }
    last.mesh = stored.mesh;
    last.time = stored.time;
    collected += stored.xdmf;
    grids = n + 1;
  }

  void begin(double time) const {
    if (!open) throw core::Error(core::ExitCode::internal, fmt::format("'{}' is closed, nothing can be written to it.", data_path));
    if (!comm.all(std::isfinite(time) && (grids == 0 || time > last.time)))
      throw core::Error(core::ExitCode::internal,
                        fmt::format("Fields must be written in the order of time; {} does not come after {}.", time, last.time));
  }

  std::string file_of(int grid) const { return series ? Frames::name(grid) : data_name; }

  void write(const Grid& grid, const std::vector<FieldData>& fields, double time) {
    begin(time);
    const Cells cells = cells_of(grid);
    check(grid, cells, fields, comm);
    const std::uint64_t found = fingerprint(grid, cells, comm);
    const bool new_mesh = grids == 0 || found != last.fingerprint;
    const int mesh = new_mesh ? grids : last.mesh;
    XdmfGrid next{grids, mesh, file_of(grids), file_of(mesh), grid.global_points, cells.global, cells.corners, time, {}};
    for (const FieldData& field : fields) next.attributes.push_back({field.name, field.centre, field.components == 1 ? 1 : 3});
    const std::string element = xdmf_grid(next, true);

    const SlabExchange points(grid.point_id, grid.point_owner, grid.global_points, "point", comm);
    const SlabExchange of_cells(cells.id, cells.owner, cells.global, cell_name(cells.corners), comm);
    const auto add_to = [&](Hdf5File& file) {
      if (new_mesh) {
        const std::string group = fmt::format("/mesh_{}", mesh);
        write_points(file, group, grid, points, found);
        file.add_array(group + "/" + cell_array(cells.corners), of_cells.slab(), cells.corners,
                       of_cells(corner_ids(grid, cells).data(), cells.corners, cells.corners));
      }
      write_values(file, next, fields, points, of_cells);
    };
    const long long room = room_of(next, new_mesh);
    if (series) {
      write_aside(frames.path(grids), comm, [&](const std::string& path) {
        Hdf5File file(path, Hdf5File::Mode::create, room + array_bytes + static_cast<long long>(element.size()), comm, seal_bytes);
        add_to(file);
        file.add_text("/xdmf", element);
        file.sync();
        file.close();
        comm.on_root([&] { write_seal(path, Frames::seal()); });
      });
    } else {
      Hdf5File file(data_path, Hdf5File::Mode::extend, room, comm);
      // Whatever stops the writing now leaves the file in an unknown state.
      open = false;
      add_to(file);
      file.close();
    }

    last = {time, mesh, found};
    if (new_mesh) meshes.push_back(mesh);
    if (++grids == 1) single = xdmf_grid(next, false);
    collected += element;
    // The text grows with each grid: without these pauses the work would grow with the square of their number.
    if (grids >= listed + std::max(1, listed / 64) || grids <= 128) list();
    open = true;
  }

  static void write_points(Hdf5File& file, const std::string& group, const Grid& grid, const SlabExchange& points,
                           std::uint64_t fingerprint) {
    file.add_group(group);
    file.add_attribute(group, "fingerprint", static_cast<GlobalIndex>(fingerprint));
    const double* coordinates = grid.points.empty() ? nullptr : grid.points.front().data();
    file.add_array(group + "/points", points.slab(), 2, points(coordinates, 2, 2));
  }

  static void write_values(Hdf5File& file, const XdmfGrid& next, const std::vector<FieldData>& fields, const SlabExchange& points,
                           const SlabExchange& cells) {
    const std::string group = fmt::format("/fields_{}", next.number);
    file.add_group(group);
    file.add_attribute(group, "time", next.time);
    file.add_attribute(group, "mesh", static_cast<GlobalIndex>(next.mesh));
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const SlabExchange& exchange = fields[k].centre == Centre::vertex ? points : cells;
      const int columns = next.attributes[k].columns;
      file.add_array(group + "/" + fields[k].name, exchange.slab(), columns,
                     exchange(fields[k].values.data(), fields[k].components, columns));
    }
  }

  void list() {
    comm.on_root([&] { write_list(); });
    listed = grids;
  }
  void write_list() const {
    if (series) write_text(data_path, file_of_links(links()));
    if (grids == 0) discard(text_path);
    else write_text(text_path, grids == 1 && !series ? xdmf_single(single) : xdmf_series(collected));
  }
  std::vector<Link> links() const {
    std::vector<Link> result;
    for (const int n : meshes) result.push_back({fmt::format("/mesh_{}", n), Frames::name(n)});
    for (int n = 0; n < grids; ++n) result.push_back({fmt::format("/fields_{}", n), Frames::name(n)});
    return result;
  }
};

FieldWriter::FieldWriter(const std::string& folder, const core::Comm& comm) : impl_(std::make_unique<Impl>(folder, comm, false)) {
  impl_->begin_file();
}

FieldWriter FieldWriter::series(const std::string& folder, const core::Comm& comm, int frames_kept) {
  auto impl = std::make_unique<Impl>(folder, comm, true);
  impl->begin_series(frames_kept);
  return FieldWriter(std::move(impl));
}

FieldWriter::FieldWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FieldWriter::FieldWriter(FieldWriter&&) noexcept = default;

FieldWriter::~FieldWriter() {
  if (!impl_) return;
  // Not collective: other ranks may be elsewhere when an error unwinds this one.
  try {
    if (impl_->comm.root() && impl_->listed < impl_->grids) impl_->write_list();
  } catch (const std::exception&) {
    return;
  }
}

void FieldWriter::write(const mesh::Mesh& mesh, const std::vector<FieldData>& fields, double time) { write(grid_of(mesh), fields, time); }
void FieldWriter::write(const Grid& grid, const std::vector<FieldData>& fields, double time) { impl_->write(grid, fields, time); }

int FieldWriter::frames() const { return impl_->grids; }

void FieldWriter::close() {
  impl_->open = false;
  if (impl_->listed < impl_->grids) impl_->list();
}

}  // namespace thixis::output
