#include "mass_form.hpp"

#include "thixis/method/cell_functions.hpp"

namespace thixis::method {
namespace {

struct AddMass {
  mesh::View<double* [2]> x;
  mesh::View<LocalIndex* [3]> vertices;
  mesh::View<const LocalIndex*> cells;
  Kokkos::View<const double**, Kokkos::LayoutRight> M;
  double factor, weight;
  LocalIndex first;
  LocalMatrices A;  ///< A <- factor A + weight 2|K| M

  KOKKOS_FUNCTION void operator()(int e) const {
    const double scale = 2 * weight * mesh::cell_area(x, vertices, cells(first + e));
    const int n = A.extent_int(1), functions = M.extent_int(0);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) A(e, i, j) = factor * A(e, i, j) + (i < functions && j < functions ? scale * M(i, j) : 0);
  }
};

}  // namespace

MassForm::MassForm(const mesh::Mesh& mesh, const mesh::View<const LocalIndex*>& cells, const reference::CellBasis& basis,
                   std::shared_ptr<const CellForm> form, double factor, double weight)
    : mesh_(mesh),
      cells_(cells),
      M_(matrix_view("thixis::method::mass", basis.size(), basis.size(), basis.mass())),
      form_(std::move(form)),
      factor_(factor),
      weight_(weight) {}

void MassForm::matrices(LocalIndex first, const LocalMatrices& A) const {
  if (form_) form_->matrices(first, A);
  else Kokkos::deep_copy(A, 0);
  Kokkos::parallel_for("thixis::method::add_mass", Kokkos::RangePolicy<>(0, A.extent_int(0)),
                       AddMass{mesh_.coordinates, mesh_.cell_vertices, cells_, M_, form_ ? factor_ : 0, weight_, first, A});
}

}  // namespace thixis::method
