#include "mass.hpp"

#include <cmath>

#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/method/cell_functions.hpp"
#include "thixis/method/gradient_form.hpp"

namespace thixis::fem {
namespace {

/// A(e, l, m) = 2|K| M(l, m)
struct LocalMass {
  mesh::View<double* [2]> x;
  mesh::View<LocalIndex* [3]> vertices;
  mesh::View<const LocalIndex*> cells;
  Kokkos::View<const double**, Kokkos::LayoutRight> M;
  LocalIndex first;
  method::LocalMatrices A;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const double scale = 2 * mesh::cell_area(x, vertices, cells(first + e));
    for (int l = 0; l < M.extent_int(0); ++l)
      for (int m = 0; m < M.extent_int(1); ++m) A(e, l, m) = scale * M(l, m);
  }
};

}  // namespace

Mass::Mass(const mesh::Mesh& mesh, const mesh::View<const LocalIndex*>& cells, const reference::CellBasis& basis,
           const method::Structure& structure)
    : comm_(mesh.comm) {
  method::Entries all = structure.entries;
  all.held.assign(all.held.size(), -1);
  const method::Numbering numbering = method::number(all, mesh.comm);
  entry_of_column_ = numbering.entry_of_column;
  const int n = basis.size();
  Kokkos::View<LocalIndex**, Kokkos::LayoutRight> elements("thixis::fem::mass_elements", structure.element_entries.extent(0), n);
  Kokkos::parallel_for(
      "thixis::fem::mass_elements", Kokkos::RangePolicy<>(0, elements.extent_int(0)), KOKKOS_LAMBDA(int k) {
        for (int l = 0; l < n; ++l) elements(k, l) = numbering.column_of_entry(structure.element_entries(k, l));
      });
  M_ = Teuchos::rcp(new algebra::Matrix(method::make_graph(numbering.rows, numbering.columns, elements)));
  M_->fillComplete();

  const auto reference = method::matrix_view("thixis::fem::mass", n, n, basis.mass());
  const LocalIndex count = cells.extent_int(0), most = std::min(method::cells_per_block(n), count);
  const method::LocalMatrices A("thixis::fem::local_mass", most, n, n);
  for (LocalIndex first = 0; first < count; first += most) {
    const method::LocalMatrices block = Kokkos::subview(A, std::pair(0, std::min(most, count - first)), Kokkos::ALL, Kokkos::ALL);
    Kokkos::parallel_for("thixis::fem::local_mass", Kokkos::RangePolicy<>(0, block.extent_int(0)),
                         LocalMass{mesh.coordinates, mesh.cell_vertices, cells, reference, first, block});
    method::scatter(elements, first, block, *M_);
  }

  algebra::LinearParams cg;
  cg.solver = algebra::SolverKind::cg;
  cg.preconditioner = algebra::PreconditionerKind::ilu;
  solver_ = std::make_unique<algebra::Solver>(cg);
  solver_->set_matrix(M_, 1, Teuchos::null);
}

Mass::~Mass() = default;

method::Coefficients Mass::solve(const std::vector<double>& moments) const {
  algebra::Vector b(M_->getRowMap()), x(M_->getRowMap());
  {
    const auto out = algebra::host_overwrite(b);
    for (std::size_t row = 0; row < out.extent(0); ++row) out(row) = moments[entry_of_column_[row]];
  }
  algebra::LinearStop stop;
  stop.tolerance = 1e-13 * b.norm2();
  if (stop.tolerance > 0) {
    const auto report = solver_->solve(b, x, stop);
    if (!report.converged && !(report.residual <= 1e-8 * b.norm2()))
      throw core::Error(core::ExitCode::not_converged, "The multiplier can not be recovered from its moments: " + report.reason + ".");
  }
  algebra::Vector ghosted(M_->getColMap());
  const auto import = M_->getGraph()->getImporter();
  if (import.is_null()) ghosted.assign(x);
  else ghosted.doImport(x, *import, Tpetra::INSERT);
  const method::Coefficients lambda("thixis::fem::multiplier", moments.size());
  const auto host = Kokkos::create_mirror_view(lambda);
  const auto in = algebra::host_view(std::as_const(ghosted));
  for (std::size_t c = 0; c < entry_of_column_.size(); ++c) host(entry_of_column_[c]) = in(c);
  Kokkos::deep_copy(lambda, host);
  return lambda;
}

}  // namespace thixis::fem
