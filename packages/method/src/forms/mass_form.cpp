#include "forms/mass_form.hpp"

#include "kernels/polynomial_kernels.hpp"

namespace thixis::method {
namespace {

struct AddMass {
  mesh::View<double* [2]> x;
  mesh::View<LocalIndex* [3]> vertices;
  mesh::View<const LocalIndex*> cells;
  Kokkos::View<const double**, Kokkos::LayoutRight> M;
  int components;
  double factor, weight;
  LocalIndex first;
  LocalMatrices A;  ///< A <- factor A + weight 2|K| M

  KOKKOS_FUNCTION void operator()(int e) const {
    const double scale = 2 * weight * mesh::cell_area(x, vertices, cells(first + e));
    const int n = A.extent_int(1), functions = components * M.extent_int(0);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const bool in_cell = i < functions && j < functions && i % components == j % components;
        A(e, i, j) = factor * A(e, i, j) + (in_cell ? scale * M(i / components, j / components) : 0);
      }
  }
};

class Mass final : public Form {
 public:
  using Form::Form;
  std::shared_ptr<const ElementForm> cells() const override { return with_mass(space(), nullptr, 0, 1); }

  double energy(const QuadratureBlock& block, LocalIndex cells, const Coefficients& uh, const std::vector<Known>& u,
                double t) const override {
    const int components = space().components();
    const View<double*> known(Kokkos::view_alloc(std::string("thixis::method::known"), Kokkos::WithoutInitializing), block.points);
    double sum = 0;
    for (int i = 0; i < components; ++i) {
      if (static_cast<std::size_t>(i) < u.size() && u[i].value) evaluate(*u[i].value, t, block, known);
      else Kokkos::deep_copy(known, 0);
      sum += value_error(cell_functions(space().basis()), block, cells, known, space().coefficients().element_entries, {components, i}, uh);
    }
    return sum;
  }
};

}  // namespace

MassForm::MassForm(const Space& space, std::shared_ptr<const ElementForm> form, double factor, double weight)
    : space_(space),
      M_(matrix_view("thixis::method::mass", space.basis().size(), space.basis().size(), space.basis().mass())),
      form_(std::move(form)),
      factor_(factor),
      weight_(weight) {}

void MassForm::matrices(LocalIndex first, const LocalMatrices& A) const {
  if (form_) form_->matrices(first, A);
  else Kokkos::deep_copy(A, 0);
  AddMass kernel;
  kernel.x = space_.mesh().coordinates;
  kernel.vertices = space_.mesh().cell_vertices;
  kernel.cells = space_.cells();
  kernel.M = M_;
  kernel.components = space_.components();
  kernel.factor = form_ ? factor_ : 0;
  kernel.weight = weight_;
  kernel.first = first;
  kernel.A = A;
  Kokkos::parallel_for("thixis::method::add_mass", Kokkos::RangePolicy<>(0, A.extent_int(0)), kernel);
}

FormPtr mass(const Space& space) { return std::make_shared<Mass>(space); }

std::shared_ptr<const ElementForm> with_mass(const Space& space, const std::shared_ptr<const ElementForm>& form, double factor,
                                             double weight) {
  return std::make_shared<MassForm>(space, form, factor, weight);
}

}  // namespace thixis::method
