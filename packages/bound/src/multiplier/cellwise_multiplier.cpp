#include "data/tables.hpp"
#include "multiplier/contact_vectors.hpp"
#include "multiplier/held_moments.hpp"
#include "multiplier/multiplier.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/reference/flux_moments.hpp"

namespace thixis::bound {
namespace {

struct FitCell {
  Kokkos::View<const LocalIndex**, Kokkos::LayoutRight> entries;
  View<const double*> moment;
  ConstCellTable held;  ///< against held functions; of length 0: none
  Matrix from_moments;  ///< (mode, l)
  Matrix to_bernstein;  ///< (b, mode)
  CellTable density;    ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int K) const {
    const int modes = to_bernstein.extent_int(1), n = from_moments.extent_int(1);
    double c[reference::max_functions] = {}, of_cell[reference::max_functions];
    bool nothing = true;
    for (int l = 0; l < n; ++l) {
      of_cell[l] = moment(entries(K, l)) + (held.extent(0) > 0 ? held(K, l) : 0);
      nothing = nothing && of_cell[l] == 0;
    }
    for (int m = 0; m < modes; ++m) {
      c[m] = 0;
      for (int l = 0; l < n && !nothing; ++l) c[m] += from_moments(m, l) * of_cell[l];
    }
    const double mean = c[0] * Kokkos::Experimental::sqrt(2.0);
    double lowest = mean;
    for (int b = 0; b < modes; ++b) {
      double value = 0;
      for (int m = 0; m < modes; ++m) value += to_bernstein(b, m) * c[m];
      lowest = value < lowest ? value : lowest;
    }
    const double part = lowest >= 0 ? 1 : mean > 0 ? mean / (mean - lowest) : 0;
    density(K, 0) = mean > 0 ? c[0] : 0;
    for (int m = 1; m < modes; ++m) density(K, m) = part * c[m];
  }
};

class CellwiseMultiplier final : public NonNegativeMultiplier {
 public:
  explicit CellwiseMultiplier(const method::Space& space) : space_(space), held_(space) {
    const auto& basis = space.basis();
    const reference::Modal modal(basis.degree());
    const auto B = reference::bernstein(space.flux_degree());
    from_moments_ = matrix_view("thixis::bound::from_moments", basis.size(), basis.size(), from_moments(basis, modal));
    to_bernstein_ = matrix_view("thixis::bound::to_bernstein", B.size, B.size, reference::modal_to_bernstein(B));
  }

  void operator()(const algebra::Vector& moments, const CellTable& density, const CellTable&) const override {
    const algebra::Vector all = at_unknowns(space_, moments);
    const auto at_entries = space_.complete(all, method::Coefficients("thixis::bound::nothing", space_.coefficients().entries.size()));
    held_(at_entries);
    Kokkos::parallel_for(
        "thixis::bound::fit_cell", Kokkos::RangePolicy<>(0, density.extent_int(0)),
        FitCell{space_.coefficients().element_entries, at_entries, held_.of_cells(), from_moments_, to_bernstein_, density});
  }

  ConstCellTable held_moments() const override { return held_.of_cells(); }

  std::size_t bytes() const override { return sizeof(double) * (from_moments_.size() + to_bernstein_.size() + held_.of_cells().size()); }

 private:
  const method::Space& space_;
  HeldMoments held_;
  Matrix from_moments_, to_bernstein_;
};

}  // namespace

std::unique_ptr<NonNegativeMultiplier> cellwise_multiplier(const method::Space& space) {
  return std::make_unique<CellwiseMultiplier>(space);
}

}  // namespace thixis::bound
