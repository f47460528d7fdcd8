#include "checks/sizes.hpp"

#include <algorithm>
#include <cmath>

#include "thixis/core/memory.hpp"

namespace thixis::drive {
namespace {

using mesh::Generator;

/// Conjugate gradients without a preconditioner took 400 to 500 bytes for each unknown of all fields, finite volumes 690.
constexpr double bytes_per_unknown = 200;

bool is_interval(const mesh::MeshParams& params) { return params.generator == Generator::interval; }

/// Of the generator, before refinement.
std::optional<double> coarsest_cells(const mesh::MeshParams& params) {
  const double n = params.cells_per_side;
  switch (params.generator) {
    case Generator::criss_cross:
    case Generator::rectangle: {
      const double width = params.upper[0] - params.lower[0], height = params.upper[1] - params.lower[1];
      const double squares = n * n * std::max(width, height) / std::min(width, height);
      return (params.generator == Generator::criss_cross ? 4 : 2) * squares;
    }
    case Generator::disk:
      return 6.0 * params.rings * params.rings;
    case Generator::interval:
      return params.cells[0];
    case Generator::tensor:
      return static_cast<double>(params.cells[0]) * params.cells[1];
    case Generator::file:
      break;
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> planned_cells(const mesh::MeshParams& params) {
  const auto coarsest = coarsest_cells(params);
  if (!coarsest) return std::nullopt;
  return std::ldexp(*coarsest, (is_interval(params) ? 1 : 2) * params.refinements);
}

double least_memory_mb(const RunParams& params, double cells) {
  const models::Catalogue& known = *params.catalogue;
  return cells * known.model(params).fields * known.method(params).unknowns_per_cell(params.method) * bytes_per_unknown / 1e6;
}

void require_memory(const RunParams& params, double cells, const core::Comm& comm) {
  const bool counted = params.mesh.generator == Generator::interval || params.mesh.generator == Generator::tensor;
  core::require_memory(least_memory_mb(params, cells), counted ? "mesh/cells" : "mesh/refinements", comm);
}

void require_memory(const RunParams& params, const core::Comm& comm) {
  if (const auto cells = planned_cells(params.mesh)) require_memory(params, *cells, comm);
}

}  // namespace thixis::drive
