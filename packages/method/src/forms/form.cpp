#include "thixis/method/form.hpp"

#include "kernels/polynomial_kernels.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"
#include "thixis/method/gradient_form.hpp"

namespace thixis::method {
namespace {

using algebra::Vector;

ElementSum cell_sum(const Form& form) { return {form.cells(), form.space().coefficients().element_entries, form.space().elements()}; }

/// action(first, A) for blocks of elements with their local matrices, so that these stay in cache.
template <class Action>
void over_elements(const core::Comm& comm, const ElementUnknowns& elements, const ElementForm& form, Action action) {
  const int n = elements.extent_int(1);
  const LocalIndex count = elements.extent_int(0), most = std::min(cells_per_block(n), count);
  const LocalMatrices A("thixis::method::local_matrices", most, n, n);
  comm.together([&] {
    for (LocalIndex first = 0; first < count; first += most) {
      const LocalMatrices block = Kokkos::subview(A, std::pair(0, std::min(most, count - first)), Kokkos::ALL, Kokkos::ALL);
      form.matrices(first, block);
      action(first, block);
    }
  });
}

void add(const core::Comm& comm, const ElementUnknowns& elements, const ElementForm& form, algebra::Matrix& A) {
  over_elements(comm, elements, form, [&](LocalIndex first, const LocalMatrices& local) { scatter(elements, first, local, A); });
}

double sum_of_energies(const Form& form, const Coefficients& uh, const std::vector<Known>& u, double t) {
  const Space& space = form.space();
  const LocalIndex owned = space.mesh().owned_cells;
  const double sum = space.mesh().comm.together([&] {
    double here = 0;
    for_each_block(space.quadrature(), [&](const QuadratureBlock& block) {
      if (block.first < owned) here += form.energy(block, std::min(block.cells, owned - block.first), uh, u, t);
    });
    return here;
  });
  return space.mesh().comm.sum(sum);
}

}  // namespace

void Form::add_weak_data(const BoundaryValues&, double, Vector&) const {}

void Form::native_flux(const scene::Field&, const Coefficients&, const BoundaryValues&, double, const HeldSource&,
                       const View<double**>&) const {
  throw core::Error(core::ExitCode::internal, "This form has no flux of its own.");
}

algebra::MatrixPtr assemble(const core::Comm& comm, const algebra::GraphPtr& graph, const ElementUnknowns& elements,
                            const ElementForm& form) {
  auto A = Teuchos::rcp(new algebra::Matrix(graph));
  A->fillComplete();
  add(comm, elements, form, *A);
  return A;
}

algebra::MatrixPtr assemble(const Form& form) {
  auto S = Teuchos::rcp(new algebra::Matrix(form.space().graph()));
  S->fillComplete();
  for (const ElementSum& sum : {cell_sum(form), form.faces()})
    if (sum.form) add(form.space().mesh().comm, sum.columns, *sum.form, *S);
  return S;
}

void apply(const Form& form, const Coefficients& u, Vector& y) {
  y.putScalar(0);
  for (const ElementSum& sum : {cell_sum(form), form.faces()}) {
    if (!sum.form) continue;
    const int n = sum.columns.extent_int(1);
    const Block2 local("thixis::method::local_forces", std::min(cells_per_block(n), sum.columns.extent_int(0)), n);
    over_elements(form.space().mesh().comm, sum.columns, *sum.form, [&](LocalIndex first, const LocalMatrices& A) {
      const Block2 part = Kokkos::subview(local, std::pair(0, A.extent_int(0)), Kokkos::ALL);
      apply(A, first, sum.entries, u, part);
      scatter(sum.columns, first, part, y);
    });
  }
}

void load(const Form& form, const Function& force, const BoundaryValues& boundary, double t, Vector& F) {
  F.putScalar(0);
  form.space().mesh().comm.together([&] {
    form.space().add_moments(force, t, F);
    form.space().add_traces(boundary.neumann, t, F);
    form.add_weak_data(boundary, t, F);
  });
}

double energy(const Form& form, const Coefficients& uh) { return sum_of_energies(form, uh, {}, 0); }

double energy_error(const Form& form, const Coefficients& uh, const std::vector<Known>& u, double t) {
  return sum_of_energies(form, uh, u, t);
}

}  // namespace thixis::method
