#include "thixis/equilibration/patch_flux.hpp"

#include <fmt/format.h>

#include "patches/patch_kernels.hpp"
#include "thixis/core/error.hpp"

namespace thixis::equilibration {

struct PatchFlux::Impl {
  virtual ~Impl() = default;
  virtual void evaluate(const Data& data, const CellTable& sigma) const = 0;
  virtual std::size_t bytes() const = 0;
  static std::unique_ptr<Impl> make(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, const std::vector<bool>& held, int q);
  template <int Q>
  struct OfDegree;
};

namespace {

template <class Kernel>
void launch(const char* label, LocalIndex count, const Kernel& kernel) {
  Kokkos::parallel_for(label, Kokkos::RangePolicy<>(0, count), kernel);
}

template <class... Views>
std::size_t bytes_of(const Views&... views) {
  return (0 + ... + (views.span() * sizeof(typename Views::value_type)));
}

}  // namespace

/// The sizes of all loops over functions are known to the compiler.
template <int Q>
struct PatchFlux::Impl::OfDegree final : Impl {
  using T = PatchTables<Q>;

  OfDegree(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, const std::vector<bool>& held)
      : owned_cells(mesh.owned_cells), patches(make_patches(mesh, cells, held, Q)) {
    using Kokkos::view_alloc;
    using Kokkos::WithoutInitializing;
    form.tables = T::make();
    form.metric = metrics(mesh, cells);
    form.inverse = Bubbles(view_alloc(WithoutInitializing, "thixis::equilibration::bubbles"), cells.extent(0), T::bubbles * T::bubbles);
    factor = View<double*>(view_alloc(WithoutInitializing, "thixis::equilibration::factor"), patches.factors);
    unknowns = View<double*>(view_alloc(WithoutInitializing, "thixis::equilibration::unknowns"), patches.unknowns);
    moments = Moments(view_alloc(WithoutInitializing, "thixis::equilibration::moments"), patches.spokes, Q + 1);
    residual = CellTable(view_alloc(WithoutInitializing, "thixis::equilibration::residual"), cells.extent(0), 3 * T::tests);
    if (T::bubbles > 0) launch("thixis::equilibration::invert_bubbles", cells.extent_int(0), InvertBubbles<Q>{form});
    launch("thixis::equilibration::factor_patch", patches.patch.extent_int(0), FactorPatch<Q>{patches, form, factor});
  }

  void evaluate(const PatchFlux::Data& data, const CellTable& sigma) const override {
    const LocalIndex count = patches.patch.extent_int(0), cells = residual.extent_int(0);
    launch("thixis::equilibration::given_flux", patches.given_spokes.extent_int(0),
           GivenFlux<Q>{patches.given_spokes, data.traction, moments});
    launch("thixis::equilibration::sweep", count, Sweep<Q>{patches, data.density, moments});
    launch("thixis::equilibration::residual", cells, Residual<Q>{form, patches, data, moments, residual});
    launch("thixis::equilibration::solve_patch", count, SolvePatch<Q>{patches, factor, residual, unknowns, moments});
    launch("thixis::equilibration::assemble", owned_cells, Assemble<Q>{form, patches, data, moments, sigma});
  }

  std::size_t bytes() const override {
    return bytes_of(patches.patch, patches.corner, patches.spoke, patches.given, patches.given_spokes, form.metric, form.inverse, factor,
                    unknowns, moments, residual);
  }

  LocalIndex owned_cells;
  Patches patches;
  CellForm<Q> form;
  View<double*> factor, unknowns;
  Moments moments;
  CellTable residual;
};

std::unique_ptr<PatchFlux::Impl> PatchFlux::Impl::make(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells,
                                                       const std::vector<bool>& held, int q) {
  switch (q) {
    case 0:
      return std::make_unique<OfDegree<0>>(mesh, cells, held);
    case 1:
      return std::make_unique<OfDegree<1>>(mesh, cells, held);
    case 2:
      return std::make_unique<OfDegree<2>>(mesh, cells, held);
    case 3:
      return std::make_unique<OfDegree<3>>(mesh, cells, held);
    case 4:
      return std::make_unique<OfDegree<4>>(mesh, cells, held);
    default:
      throw core::Error(core::ExitCode::internal, fmt::format("Fluxes on patches are built for degrees 0 to 4, not {}.", q));
  }
}

PatchFlux::PatchFlux(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, const std::vector<bool>& held, int q)
    : impl_(Impl::make(mesh, cells, held, q)) {}
PatchFlux::~PatchFlux() = default;

void PatchFlux::operator()(const Data& data, const CellTable& sigma) const { impl_->evaluate(data, sigma); }

std::size_t PatchFlux::bytes() const { return impl_->bytes(); }

}  // namespace thixis::equilibration
