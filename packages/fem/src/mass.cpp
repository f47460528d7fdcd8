#include "mass.hpp"

#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"
#include "thixis/method/form.hpp"

namespace thixis::fem {
namespace {

using Range = Kokkos::RangePolicy<algebra::Vector::execution_space>;

/// (cell, l) -> column of the numbering.
method::ElementUnknowns columns_of(const method::Structure& structure, int n, const method::Numbering& numbering) {
  const Kokkos::View<LocalIndex**, Kokkos::LayoutRight> elements("thixis::fem::mass_elements", structure.element_entries.extent(0), n);
  const auto entries = structure.element_entries;
  const auto column = numbering.column_of_entry;
  Kokkos::parallel_for(
      "thixis::fem::mass_elements", Kokkos::RangePolicy<>(0, elements.extent_int(0)), KOKKOS_LAMBDA(int k) {
        for (int l = 0; l < n; ++l) elements(k, l) = column(entries(k, l));
      });
  return elements;
}

}  // namespace

Mass::Mass(const method::Space& space) : space_(space) {
  method::Entries all = space.coefficients().entries;
  all.held.assign(all.held.size(), -1);
  const method::Numbering numbering = method::number(all, space.mesh().comm);
  entry_of_column_ = numbering.entry_of_column;
  const auto elements = columns_of(space.coefficients(), space.basis().size(), numbering);
  const auto graph = method::make_graph(numbering.rows, numbering.columns, elements);
  M_ = method::assemble(space.mesh().comm, graph, elements, *method::with_mass(space, nullptr, 0, 1));

  algebra::LinearParams cg;
  cg.solver = algebra::SolverKind::cg;
  cg.preconditioner = algebra::PreconditionerKind::ilu;
  solver_ = std::make_unique<algebra::Solver>(cg);
  solver_->set_matrix(M_, 1);
}

Mass::~Mass() = default;

method::Coefficients Mass::solve(const algebra::Vector& X3) const {
  const auto entry = entry_of_column_;
  const auto column = space_.numbering().column_of_entry;
  algebra::Vector b(M_->getRowMap()), x(M_->getRowMap());
  {
    const auto out = b.getLocalViewDevice(Tpetra::Access::OverwriteAll);
    const auto moments = X3.getLocalViewDevice(Tpetra::Access::ReadOnly);
    Kokkos::parallel_for(
        "thixis::fem::moments", Range(0, out.extent_int(0)), KOKKOS_LAMBDA(int row) {
          const LocalIndex at = column(entry(row));
          out(row, 0) = at < 0 ? 0 : moments(at, 0);
        });
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
  const method::Coefficients lambda("thixis::fem::multiplier", space_.coefficients().entries.size());
  const auto in = std::as_const(ghosted).getLocalViewDevice(Tpetra::Access::ReadOnly);
  Kokkos::parallel_for(
      "thixis::fem::multiplier", Range(0, entry.extent_int(0)), KOKKOS_LAMBDA(int c) { lambda(entry(c)) = in(c, 0); });
  return lambda;
}

}  // namespace thixis::fem
