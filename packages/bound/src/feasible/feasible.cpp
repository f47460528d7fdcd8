#include "thixis/bound/feasible.hpp"

#include "data/on_host.hpp"
#include "data/sources.hpp"
#include "feasible/pair_on_mesh.hpp"
#include "thixis/core/assert.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::bound {
namespace {

void resize(View<double*>& values, const char* label, LocalIndex count) {
  if (values.extent_int(0) != count) values = View<double*>(std::string(label), count);
}

}  // namespace

FeasiblePair::FeasiblePair(const method::Space& space, const Problem& problem) : impl_(std::make_unique<Impl>(space, problem)) {}
FeasiblePair::FeasiblePair(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FeasiblePair::~FeasiblePair() = default;

void FeasiblePair::evaluate(const method::Coefficients (&u)[2], const ConstCellTable& lambda, int degree, Parts& parts, double small,
                            Gaps gaps) const {
  THIXIS_ASSERT_LE(degree, max_density_degree, "densities have tables up to that degree");
  const LocalIndex cells = impl_->space.mesh().owned_cells;
  resize(parts.whole, "thixis::bound::whole", cells);
  resize(parts.at_nodes, "thixis::bound::at_nodes", cells);
  resize(parts.rest, "thixis::bound::rest", cells);
  resize(parts.contact, "thixis::bound::contact", cells);

  FeasibleParts kernel = impl_->kernel;
  kernel.s_c[1] = impl_->data[1];
  for (int alpha = 0; alpha < kernel.count; ++alpha) {
    kernel.u[alpha] = u[alpha];
    kernel.s_c[alpha] = u[alpha];
    if (!impl_->averages) continue;
    (*impl_->averages)(u[alpha], impl_->data[alpha], impl_->averaged[alpha]);
    kernel.s_c[alpha] = impl_->averaged[alpha];
  }
  kernel.noise = impl_->noise({kernel.s_c[0], kernel.s_c[1]});
  kernel.small = small;
  kernel.lambda = lambda;
  if (gaps == Gaps::pressed) {
    Pressing& pressing = impl_->pressing();
    pressing(kernel);
    kernel.closed = pressing.closed();
    kernel.followed = pressing.followed();
  }
  kernel.density.degree = degree;
  kernel.whole = parts.whole;
  kernel.at_nodes = parts.at_nodes;
  kernel.rest = parts.rest;
  kernel.contact = parts.contact;
  kernel.at_points = View<bool>("thixis::bound::at_points");
  Kokkos::parallel_for("thixis::bound::feasible_parts", Kokkos::RangePolicy<>(0, cells), kernel);
  parts.at_points = on_host(kernel.at_points)();
  impl_->lift->add_remainder(parts.whole);
  impl_->lift->add_remainder(parts.rest);
}

double FeasiblePair::change_by_interpolation() const {
  const mesh::Mesh& mesh = impl_->space.mesh();
  const auto held = method::held_vertices(mesh, held_tags(impl_->problem.boundary[0]));
  const auto host = mesh::on_host(mesh);
  double area = 0;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    for (int i = 0; i < 3; ++i)
      if (held[host.cell_vertices(K, i)] >= 0) {
        area += mesh::cell_area(host.coordinates, host.cell_vertices, K);
        break;
      }
  return 2 * mesh.comm.max(impl_->lift->largest()) * std::sqrt(impl_->problem.count * mesh.comm.sum(area));
}

std::array<double, 2> FeasiblePair::apart() const { return {impl_->kernel.apart[0], impl_->kernel.apart[1]}; }

bool FeasiblePair::obstacle_is_interpolated() const { return !impl_->kernel.deviation.of_obstacle; }

View<const bool*> FeasiblePair::jumps() const {
  const method::Jumps& jumps = impl_->jumps;
  const View<bool*> of_cells("thixis::bound::jumps", jumps.of_cells.size());
  const auto host = Kokkos::create_mirror_view(of_cells);
  for (std::size_t k = 0; k < jumps.of_cells.size(); ++k) host(k) = jumps.of_cells[k].jumps;
  Kokkos::deep_copy(of_cells, host);
  return of_cells;
}

double FeasiblePair::boundary_energy() const { return impl_->lift->energy(); }

std::size_t FeasiblePair::bytes() const {
  const auto of = [](const auto&... views) { return (std::size_t{0} + ... + (views.span() * sizeof(*views.data()))); };
  const FeasibleParts& k = impl_->kernel;
  return of(impl_->data[0], impl_->data[1], impl_->averaged[0], impl_->averaged[1], k.theta, k.move_tension, k.lift.place, k.lift.energy,
            k.lift.products, k.deviation.place, k.deviation.bound, k.deviation.at_points, k.energy.mu.at_points[0],
            k.energy.mu.at_points[1]) +
         (impl_->averages ? of(k.of_cells) : 0) + (impl_->known_pressing ? impl_->known_pressing->bytes() : 0);
}

}  // namespace thixis::bound
