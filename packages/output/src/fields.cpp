#include "thixis/output/fields.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "grid.hpp"
#include "hdf5_file.hpp"
#include "slabs.hpp"
#include "text_file.hpp"
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
  bool open = true;
  XdmfGrid last;
  int grids = 0, listed = 0;  ///< written so far, and how many of them the XDMF file lists
  std::uint64_t mesh_fingerprint = 0;
  std::string single, series;  ///< elements of the XDMF file

  Impl(const std::string& folder, const core::Comm& on_comm)
      : data_path((std::filesystem::path(folder) / data_name).string()),
        text_path((std::filesystem::path(folder) / "fields.xdmf").string()),
        comm(on_comm) {
    comm.on_root([&] {
      std::error_code absent;
      std::filesystem::remove(text_path, absent);
    });
    Hdf5File(data_path, Hdf5File::Mode::create, group_bytes, comm).close();
  }

  void begin(double time) const {
    if (!open) throw core::Error(core::ExitCode::internal, fmt::format("'{}' is closed, nothing can be written to it.", data_path));
    if (!comm.all(std::isfinite(time) && (grids == 0 || time > last.time)))
      throw core::Error(core::ExitCode::internal,
                        fmt::format("Fields must be written in the order of time; {} does not come after {}.", time, last.time));
  }

  void write(const Grid& grid, const std::vector<FieldData>& fields, double time) {
    begin(time);
    const Cells cells = cells_of(grid);
    check(grid, cells, fields, comm);
    const std::uint64_t found = fingerprint(grid, cells, comm);
    const bool new_mesh = grids == 0 || found != mesh_fingerprint;
    XdmfGrid next{grids, new_mesh ? grids : last.mesh, grid.global_points, cells.global, cells.corners, time, {}};
    for (const FieldData& field : fields) next.attributes.push_back({field.name, field.centre, field.components == 1 ? 1 : 3});

    const SlabExchange points(grid.point_id, grid.point_owner, grid.global_points, "point", comm);
    const SlabExchange of_cells(cells.id, cells.owner, cells.global, cell_name(cells.corners), comm);
    Hdf5File file(data_path, Hdf5File::Mode::extend, room_of(next, new_mesh), comm);
    // Whatever stops the writing now leaves the file in an unknown state.
    open = false;
    if (new_mesh) {
      const std::string mesh = fmt::format("/mesh_{}", next.mesh);
      write_points(file, mesh, grid, points);
      file.add_array(mesh + "/" + cell_array(cells.corners), of_cells.slab(), cells.corners,
                     of_cells(corner_ids(grid, cells).data(), cells.corners, cells.corners));
    }
    const std::string group = fmt::format("/fields_{}", next.number);
    file.add_group(group);
    file.add_attribute(group, "time", time);
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const SlabExchange& exchange = fields[k].centre == Centre::vertex ? points : of_cells;
      const int columns = next.attributes[k].columns;
      file.add_array(group + "/" + fields[k].name, exchange.slab(), columns,
                     exchange(fields[k].values.data(), fields[k].components, columns));
    }
    file.close();

    mesh_fingerprint = found;
    last = std::move(next);
    if (++grids == 1) single = xdmf_grid(last, data_name, false);
    series += xdmf_grid(last, data_name, true);
    // The text grows with each grid: without these pauses the work would grow with the square of their number.
    if (grids >= listed + std::max(1, listed / 64) || grids <= 128) list();
    open = true;
  }

  static void write_points(Hdf5File& file, const std::string& group, const Grid& grid, const SlabExchange& points) {
    file.add_group(group);
    const double* coordinates = grid.points.empty() ? nullptr : grid.points.front().data();
    file.add_array(group + "/points", points.slab(), 2, points(coordinates, 2, 2));
  }

  void list() {
    comm.on_root([&] { write_list(); });
    listed = grids;
  }
  void write_list() const { write_text(text_path, grids == 1 ? xdmf_single(single) : xdmf_series(series)); }
};

FieldWriter::FieldWriter(const std::string& folder, const core::Comm& comm) : impl_(std::make_unique<Impl>(folder, comm)) {}

FieldWriter::~FieldWriter() {
  // Not collective: other ranks may be elsewhere when an error unwinds this one.
  try {
    if (impl_->comm.root() && impl_->listed < impl_->grids) impl_->write_list();
  } catch (const std::exception&) {
    return;
  }
}

void FieldWriter::write(const mesh::Mesh& mesh, const std::vector<FieldData>& fields, double time) { write(grid_of(mesh), fields, time); }
void FieldWriter::write(const Grid& grid, const std::vector<FieldData>& fields, double time) { impl_->write(grid, fields, time); }

void FieldWriter::close() {
  impl_->open = false;
  if (impl_->listed < impl_->grids) impl_->list();
}

}  // namespace thixis::output
