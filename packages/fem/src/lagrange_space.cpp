#include "thixis/fem/lagrange_space.hpp"

#include <algorithm>

#include "kernels.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"
#include "thixis/method/quadrature.hpp"
#include "thixis/reference/quadrature.hpp"
#include "vertex_numbering.hpp"

namespace thixis::fem {
namespace {

using algebra::Vector;
using method::BoundaryValues;
using method::Coefficients;

/// Continuous P1. Coefficients are numbered by local vertices.
class LagrangeSpace final : public method::Space {
 public:
  LagrangeSpace(const mesh::Mesh& mesh, const method::SpaceOptions& options)
      : mesh_(mesh), numbering_(number_vertices(mesh, options.dirichlet)), options_(options), pairing_(numbering_.rows) {
    cells_ = Kokkos::View<LocalIndex*>("thixis::fem::cells", numbering_.patch_cells.size());
    Kokkos::deep_copy(cells_, Kokkos::View<const LocalIndex*, Kokkos::HostSpace>(numbering_.patch_cells.data(), numbering_.patch_cells.size()));
    graph_ = method::make_graph(numbering_.rows, numbering_.columns, numbering_.cell_columns);
    make_coordinates();
    over_blocks([&](LocalIndex first, LocalIndex count) {
      const Block2 d("thixis::fem::mean_values", count, 3);
      mean_values(mesh_, cells_, first, d);
      method::scatter(numbering_.cell_columns, first, d, pairing_);
    });
  }

  const mesh::Mesh& mesh() const override { return mesh_; }
  algebra::MapPtr map() const override { return numbering_.rows; }
  algebra::GraphPtr graph() const override { return graph_; }
  Teuchos::RCP<const algebra::MultiVector> coordinates() const override { return coordinates_; }
  const Vector& pairing() const override { return pairing_; }

  algebra::MatrixPtr stiffness(const scene::Field& tension) const override {
    auto S = Teuchos::rcp(new algebra::Matrix(graph_));
    S->fillComplete();
    const Block3 A("thixis::fem::stiffness", std::min<std::size_t>(method::block_size, cells_.extent(0)), 3, 3);
    over_blocks([&](LocalIndex first, LocalIndex count) {
      const auto block = Kokkos::subview(A, std::pair(0, count), Kokkos::ALL, Kokkos::ALL);
      fem::stiffness(mesh_, cells_, first, mean_tension(tension, first, count), block);
      method::scatter(numbering_.cell_columns, first, block, *S);
    });
    return S;
  }

  Coefficients lift(const BoundaryValues& boundary, double t) const override {
    const Coefficients values("thixis::fem::lift", mesh_.vertices);
    const auto host = Kokkos::create_mirror_view(values);
    Kokkos::deep_copy(host, 0);
    for (std::size_t tag = 0; tag < boundary.dirichlet.size(); ++tag) {
      if (!boundary.dirichlet[tag]) continue;
      std::vector<LocalIndex> held;
      for (LocalIndex v = 0; v < mesh_.vertices; ++v)
        if (numbering_.dirichlet_tag[v] == static_cast<LocalIndex>(tag)) held.push_back(v);
      const auto g = at(*boundary.dirichlet[tag], held, t);
      for (std::size_t k = 0; k < held.size(); ++k) host(held[k]) = g[k];
    }
    Kokkos::deep_copy(values, host);
    return values;
  }

 private:
  /// f(first, count) for blocks of patch cells.
  template <class F>
  void over_blocks(F f) const {
    const LocalIndex cells = cells_.extent_int(0);
    for (LocalIndex first = 0; first < cells; first += method::block_size) f(first, std::min(method::block_size, cells - first));
  }
  const mesh::Mesh& mesh_;
  VertexNumbering numbering_;
  method::SpaceOptions options_;
  Vector pairing_;
  Kokkos::View<LocalIndex*> cells_;
  algebra::GraphPtr graph_;
  Teuchos::RCP<const algebra::MultiVector> coordinates_;
};

}  // namespace
