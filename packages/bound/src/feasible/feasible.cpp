#include "thixis/bound/feasible.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "data/sources.hpp"
#include "data/tables.hpp"
#include "data/tension_bounds.hpp"
#include "feasible/averages.hpp"
#include "feasible/deviation.hpp"
#include "feasible/pressing.hpp"
#include "thixis/core/assert.hpp"
#include "thixis/method/gradient_form.hpp"

namespace thixis::bound {
namespace {

/// Those of the space itself where it has continuous functions.
ContinuousNodes nodes_of(const method::PolynomialSpace& space, const std::vector<bool>& dirichlet) {
  if (!space.conforming()) return continuous_nodes(space.mesh(), space.cells(), space.basis(), space.basis().points(), dirichlet);
  ContinuousNodes nodes{space.coefficients().entries, space.coefficients().element_entries};
  nodes.entries.held = space.numbering().held;
  return nodes;
}

/// theta_1 = mu_2/(mu_1 + mu_2) at the nodes; for Bernstein coefficients at the places of the regular lattice.
std::vector<double> shares(const method::PolynomialSpace& space, const ContinuousNodes& nodes,
                           const std::array<scene::FieldPtr, 2>& tension) {
  const auto host = mesh::on_host(space.mesh());
  const auto of_cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), nodes.of_cells);
  const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.cells());
  const auto& lattice = space.basis().lattice();
  const bool bernstein = space.basis().family() == reference::Family::bernstein;
  const std::size_t count = nodes.entries.size();
  std::vector<double> x(count), y(count), mu[2];
  for (std::size_t e = 0; e < count; ++e) {
    x[e] = nodes.entries.point[e][0];
    y[e] = nodes.entries.point[e][1];
  }
  for (std::size_t k = 0; bernstein && k < of_cells.extent(0); ++k)
    for (int l = 0; l < space.basis().size(); ++l) {
      const double xi = lattice[2 * l], eta = lattice[2 * l + 1], lambda[3] = {1 - xi - eta, xi, eta};
      double place[2] = {0, 0};
      for (int a = 0; a < 3; ++a)
        for (int d = 0; d < 2; ++d) place[d] += lambda[a] * host.coordinates(host.cell_vertices(cells(k), a), d);
      x[of_cells(k, l)] = place[0];
      y[of_cells(k, l)] = place[1];
    }
  for (int alpha = 0; alpha < 2; ++alpha) {
    mu[alpha].resize(count);
    tension[alpha]->evaluate({count, x.data(), y.data()}, 0, mu[alpha].data());
  }
  std::vector<double> share(count);
  for (std::size_t e = 0; e < count; ++e) {
    const double both = mu[0][e] + mu[1][e];
    share[e] = both > 0 ? std::clamp(mu[1][e] / both, 0.0, 1.0) : 0.5;
  }
  return share;
}

double mean(const core::Comm& comm, const View<const double*>& values) {
  double sum = 0;
  for (std::size_t i = 0; i < values.extent(0); ++i) sum += values(i);
  return comm.sum(sum) / static_cast<double>(std::max(1LL, comm.sum(static_cast<long long>(values.extent(0)))));
}

void resize(View<double*>& values, const char* label, LocalIndex count) {
  if (values.extent_int(0) != count) values = View<double*>(std::string(label), count);
}

/// u_h - s_c, s_c - s_N and the gap of s_N in a cell.
struct WayOfCells {
  CellEntries of_cells, of_cells_u;
  View<const double*> theta;
  double apart[2];
  method::CellFunctions functions;
  Matrix modal;
  int count;
  View<const double*> upper, lower;  ///< s_c
  method::Coefficients u1, u2;
  CellTable averages1, averages2, closing1, closing2, gap;  ///< out, overwritten

  KOKKOS_FUNCTION void put(int K, const double* c, const CellTable& out) const {
    const int n = functions.size();
    for (int m = 0; m < n; ++m) {
      double value = 0;
      for (int l = 0; l < n; ++l) value += modal(m, l) * c[l];
      out(K, m) = value;
    }
  }
  KOKKOS_FUNCTION void operator()(int K) const {
    const int n = functions.size();
    double open[reference::max_functions], closing[2][reference::max_functions], jump[reference::max_functions];
    for (int l = 0; l < n; ++l) {
      const LocalIndex e = of_cells(K, l);
      open[l] = upper(e) - lower(e);
      const double below = open[l] < 0 ? -open[l] : 0, share = theta.extent(0) > 0 ? theta(e) : apart[0];
      closing[0][l] = -share * below;
      closing[1][l] = (1 - share) * below;
      if (below > 0) open[l] = 0;
    }
    double c[reference::max_functions];
    functions.to_bernstein(open, c);
    for (int k = 0; k < n; ++k) gap(K, k) = c[k];
    for (int alpha = 0; alpha < count; ++alpha) {
      const CellTable &of_averages = alpha == 0 ? averages1 : averages2, &of_closing = alpha == 0 ? closing1 : closing2;
      if (of_closing.extent(0) > 0) put(K, closing[alpha], of_closing);
      if (of_averages.extent(0) == 0) continue;
      for (int l = 0; l < n; ++l) jump[l] = (alpha == 0 ? u1 : u2)(of_cells_u(K, l)) - (alpha == 0 ? upper : lower)(of_cells(K, l));
      put(K, jump, of_averages);
    }
  }
};

/// |max(-g, 0) - max(-g', 0)| <= |g - g'|, and <= max(-g, 0) + max(-g', 0) <= what the coefficients say; it vanishes where both g, g' >= 0.
struct NegativePartInTime {
  FeasibleParts now, then;
  bool has_then;
  CellTable gap, gap_before;
  View<double* [2]> change_of_lift;
  View<double*> size;  ///< out, overwritten

  KOKKOS_FUNCTION double lowest(const FeasibleParts& of, int K, const double* c) const {
    double low = 0;
    for (int k = 0; k < of.functions.size(); ++k) low = c[k] < low ? c[k] : low;
    const LocalIndex place = of.deviation(K);
    return place < 0 ? -low : of.deviation.bound(place) - low;
  }
  KOKKOS_FUNCTION void operator()(int K) const {
    const int n = now.functions.size();
    size(K) = 0;
    const bool moves = now.moves(K, &gap(K, 0)), moved = has_then && then.moves(K, &gap_before(K, 0));
    if (!moves && !moved) return;
    const double area = mesh::cell_geometry(now.x, now.vertices, K).area;
    const double at_most = std::sqrt(area) * ((moves ? lowest(now, K, &gap(K, 0)) : 0) + (moved ? lowest(then, K, &gap_before(K, 0)) : 0));
    size(K) = at_most;
    if (!has_then) return;
    double square = 0;
    for (int m = 0; m < n; ++m) {
      double value = 0;
      for (int k = 0; k < n; ++k) value += now.to_modal(m, k) * (gap(K, k) - gap_before(K, k));
      square += value * value;
    }
    double change = std::sqrt(2 * area * square);
    for (int alpha = 0; change_of_lift.extent(0) > 0 && alpha < 2; ++alpha) change += change_of_lift(K, alpha);
    size(K) = change < at_most ? change : at_most;
  }
};

}  // namespace

struct FeasiblePair::Impl {
  Impl(const method::PolynomialSpace& space_, const Problem& problem_)
      : space(space_), problem(problem_), nodes(nodes_of(space, held_tags(problem.boundary[0]))), monomials(density_monomials()) {
    set_tensions();
    set_kernel();
    if (problem.count == 1)
      jumps = space.mesh().comm.together([&] { return method::jumps_in_cells(space.quadrature(), *problem.obstacle, 0); });
    set_boundary(nullptr);
    if (space.conforming()) return;
    averages.emplace(space, nodes);
    for (int alpha = 0; alpha < problem.count; ++alpha) averaged[alpha] = at_nodes();
  }
  /// The same but for the boundary data.
  Impl(const Impl& other, double time)
      : space(other.space),
        problem(other.problem),
        nodes(other.nodes),
        jumps(other.jumps),
        monomials(other.monomials),
        modal(other.modal),
        tension(other.tension),
        kernel(other.kernel),
        averages(other.averages) {
    problem.time = time;
    set_boundary(other.lift.get());
    for (int alpha = 0; averages && alpha < problem.count; ++alpha) averaged[alpha] = at_nodes();
  }

  View<double*> at_nodes() const { return View<double*>("thixis::bound::averaged", nodes.entries.size()); }

  void set_tensions() {
    const core::Comm& comm = space.mesh().comm;
    const bool both = problem.count == 2;
    bool varying = false;
    double typical[2] = {0, 0};
    std::vector<double> most[2];
    for (int alpha = 0; alpha < problem.count; ++alpha) {
      const TensionBounds bounds = tension_bounds(space, *problem.tension[alpha]);
      if (const double* mu = problem.tension[alpha]->constant()) {
        typical[alpha] = tension.constant[alpha] = *mu;
      } else {
        varying = true;
        tension.at_points[alpha] = bounds.at_points;
        typical[alpha] = mean(comm, tension.at_points[alpha]);
      }
      most[alpha] = bounds.most;
    }
    kernel.apart[0] = both ? typical[1] / (typical[0] + typical[1]) : 1;
    kernel.apart[1] = 1 - kernel.apart[0];
    const double* const apart = kernel.apart;
    kernel.constant_move_tension = typical[0] * apart[0] * apart[0] + typical[1] * apart[1] * apart[1];
    if (!varying) return;
    const View<double*> of_move("thixis::bound::move_tension", space.mesh().owned_cells);
    for (LocalIndex K = 0; K < space.mesh().owned_cells; ++K)
      for (int alpha = 0; alpha < problem.count; ++alpha) of_move(K) += most[alpha][K] * apart[alpha] * apart[alpha];
    kernel.move_tension = of_move;
    if (both) kernel.theta = to_view("thixis::bound::theta", comm.together([&] { return shares(space, nodes, problem.tension); }));
  }

  void set_kernel() {
    const mesh::Mesh& mesh = space.mesh();
    kernel.count = problem.count;
    kernel.x = mesh.coordinates;
    kernel.vertices = mesh.cell_vertices;
    kernel.functions = method::cell_functions(space.basis());
    kernel.energy = {space.basis().bernstein(), gradient_products(space.basis()), space.quadrature(), tension};
    kernel.first_vertex = space.basis().interior();
    kernel.negative_part = negative_part(space.basis(), kernel.energy.products);
    kernel.to_modal = bernstein_to_modal(space.basis());
    kernel.of_cells = nodes.of_cells;
    kernel.density.to_monomials = monomials;
    const int n = space.basis().size();
    const reference::Modal orthonormal(space.basis().degree());
    modal = matrix("thixis::bound::to_modal", n, n, to_modal(space.basis(), orthonormal));
    if (!space.conforming()) kernel.of_cells_u = space.coefficients().element_entries;
  }

  /// `other`: a lift at another time.
  void set_boundary(const BoundaryLift* other) {
    std::vector<double> held[2];
    space.mesh().comm.together([&] {
      for (int alpha = 0; alpha < problem.count; ++alpha)
        held[alpha] = boundary_coefficients(space, nodes, problem.boundary[alpha].dirichlet, problem.time);
      if (problem.count == 1) held[1] = obstacle_coefficients(space, nodes, *problem.obstacle, jumps);
    });
    // Bernstein coefficients of ordered data need not be ordered
    for (LocalIndex e = 0; e < nodes.entries.size(); ++e) {
      const double below = std::max(held[1][e] - held[0][e], 0.0), share = kernel.theta.extent(0) > 0 ? kernel.theta(e) : kernel.apart[0];
      if (nodes.entries.held[e] < 0 || below == 0) continue;
      held[0][e] += share * below;
      held[1][e] -= (1 - share) * below;
    }
    lift = std::make_unique<BoundaryLift>(space, nodes, problem.tension, problem.boundary, held, problem.count, problem.time, other);
    kernel.lift = lift->of_cells();
    double size = 0;
    for (const auto& values : held)
      for (const double value : values) size = std::max(size, std::abs(value));
    size = space.mesh().comm.max(size);
    if (problem.count == 2) kernel.deviation = deviation_of_membranes(space, *lift, held_tags(problem.boundary[0]), 1e-12 * size);
    else set_obstacle(held[1], held[0]);
    for (int alpha = 0; alpha < 2; ++alpha) data[alpha] = to_view("thixis::bound::held", held[alpha]);
  }

  /// `psi`: psi_I, `g`: the boundary data.
  void set_obstacle(const std::vector<double>& psi, const std::vector<double>& g) {
    const auto above = majorant(space, nodes, jumps, psi, g);
    kernel.deviation =
        deviation_of_obstacle(space, *lift, nodes, problem.obstacle, above.empty() ? psi : above, jumps, held_tags(problem.boundary[0]));
    if (above.empty()) return;
    kernel.majorant = to_view("thixis::bound::majorant", above);
    kernel.excess = excess_of_majorant(space, nodes, *problem.obstacle, above, jumps);
  }

  /// Vertices of cells in which the obstacle jumps: there s lies on a majorant.
  std::vector<bool> of_jumps() const {
    std::vector<bool> vertices(space.mesh().vertices, false);
    const auto host = mesh::on_host(space.mesh());
    const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.cells());
    for (std::size_t k = 0; k < cells.extent(0); ++k)
      for (int i = 0; i < 3 && jumps.at(static_cast<LocalIndex>(k)); ++i) vertices[host.cell_vertices(cells(k), i)] = true;
    return vertices;
  }
  /// Set up when it is first asked for. Collective.
  Pressing& pressing() {
    if (!known_pressing) known_pressing = std::make_unique<Pressing>(space, kernel, held_tags(problem.boundary[0]), of_jumps());
    return *known_pressing;
  }

  /// Gaps below are round-off. Collective.
  double noise(const Continuous& s_c) const {
    double size = 0;
    Kokkos::parallel_reduce(
        "thixis::bound::size", Kokkos::RangePolicy<>(0, s_c[0].extent(0)),
        KOKKOS_LAMBDA(std::size_t e, double& most) {
          for (const auto& s : s_c) most = std::max(most, std::abs(s(e)));
        },
        Kokkos::Max<double>(size));
    return 1e-13 * space.mesh().comm.max(size);
  }

  const method::PolynomialSpace& space;
  Problem problem;
  ContinuousNodes nodes;
  method::Jumps jumps;  ///< of the obstacle
  Matrix monomials;
  Matrix modal;  ///< (m, l): modal coefficients of basis functions
  Tension tension;
  FeasibleParts kernel;
  View<const double*> data[2];  ///< coefficients on the held boundary; over an obstacle [1] is psi_I
  std::unique_ptr<BoundaryLift> lift;
  std::optional<Averages> averages;
  View<double*> averaged[2];
  std::unique_ptr<Pressing> known_pressing;
};

FeasiblePair::FeasiblePair(const method::PolynomialSpace& space, const Problem& problem) : impl_(std::make_unique<Impl>(space, problem)) {}
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
  Kokkos::fence();
  parts.at_points = kernel.at_points();
  for (const auto& [cell, energy] : impl_->lift->remainder()) {
    parts.whole(cell) += energy;
    parts.rest(cell) += energy;
  }
}

std::unique_ptr<FeasiblePair> FeasiblePair::at(double time) const {
  return std::unique_ptr<FeasiblePair>(new FeasiblePair(std::make_unique<Impl>(*impl_, time)));
}
double FeasiblePair::time() const { return impl_->problem.time; }

FeasiblePair::Continuous FeasiblePair::continuous(const method::Coefficients (&u)[2]) const {
  Continuous s_c = {u[0], impl_->problem.count == 2 ? View<const double*>(u[1]) : impl_->data[1]};
  for (int alpha = 0; impl_->averages && alpha < impl_->problem.count; ++alpha) {
    const auto average = impl_->at_nodes();
    (*impl_->averages)(u[alpha], impl_->data[alpha], average);
    s_c[alpha] = average;
  }
  return s_c;
}

FeasiblePair::Way FeasiblePair::way(const method::Coefficients (&u)[2], const Continuous& s_c) const {
  const method::PolynomialSpace& space = impl_->space;
  const LocalIndex cells = space.mesh().owned_cells;
  const int n = space.basis().size(), count = impl_->problem.count;
  const FeasibleParts& kernel = impl_->kernel;
  const bool averages = impl_->averages.has_value();
  int below = 0;
  const auto &above = s_c[0], &under = s_c[1];
  const auto of_cells = kernel.of_cells;
  Kokkos::parallel_reduce(
      "thixis::bound::any_below", Kokkos::RangePolicy<>(0, cells),
      KOKKOS_LAMBDA(int K, int& found) {
        for (int l = 0; l < n; ++l) found = above(of_cells(K, l)) < under(of_cells(K, l)) ? 1 : found;
      },
      Kokkos::Max<int>(below));
  const bool closes = space.mesh().comm.max(below) > 0;
  Way way;
  const auto table = [&] { return CellTable("thixis::bound::way", cells, n); };
  way.gap = table();
  for (int alpha = 0; alpha < count; ++alpha) {
    if (averages) way.averages[alpha] = table();
    if (closes) way.closing[alpha] = table();
  }
  WayOfCells of{kernel.of_cells,
                kernel.of_cells_u,
                kernel.theta,
                {kernel.apart[0], kernel.apart[1]},
                kernel.functions,
                impl_->modal,
                count,
                s_c[0],
                s_c[1],
                u[0],
                u[1],
                way.averages[0],
                way.averages[1],
                way.closing[0],
                way.closing[1],
                way.gap};
  Kokkos::parallel_for("thixis::bound::way", Kokkos::RangePolicy<>(0, cells), of);
  return way;
}

void FeasiblePair::contact(const Continuous& s_c, const ConstCellTable& lambda, int degree, const View<double*>& contact,
                           double small) const {
  FeasibleParts kernel = impl_->kernel;
  for (int alpha = 0; alpha < 2; ++alpha) kernel.s_c[alpha] = s_c[alpha];
  kernel.noise = impl_->noise(s_c);
  kernel.small = small;
  kernel.lambda = lambda;
  kernel.density.degree = degree;
  Kokkos::parallel_for(
      "thixis::bound::contact", Kokkos::RangePolicy<>(0, contact.extent(0)),
      KOKKOS_LAMBDA(int K) { contact(K) = kernel.contact_alone(K); });
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

View<double* [2]> FeasiblePair::change_of_lift(const FeasiblePair* before) const {
  return before == this ? View<double* [2]>() : impl_->lift->change(before ? before->impl_->lift.get() : nullptr);
}

void FeasiblePair::change_of_move(const CellTable& gap, const View<double* [2]>& change_of_lift, const FeasiblePair* before,
                                  const CellTable& gap_before, const View<double*>& size) const {
  const FeasibleParts now = impl_->kernel, then = before ? before->impl_->kernel : impl_->kernel;
  NegativePartInTime of{now, then, before != nullptr, gap, gap_before, change_of_lift, size};
  Kokkos::parallel_for("thixis::bound::negative_part_in_time", Kokkos::RangePolicy<>(0, size.extent(0)), of);
}

FeasiblePair::Bulge FeasiblePair::bulge(const FeasiblePair& before, const FeasiblePair& after) const {
  const method::PolynomialSpace& space = impl_->space;
  const core::Comm& comm = space.mesh().comm;
  const int count = impl_->problem.count, n = space.basis().size();
  std::vector<double> d[2];
  double most = 0, size = 0;
  comm.together([&] {
    for (int alpha = 0; alpha < count; ++alpha) {
      d[alpha] = boundary_coefficients(space, impl_->nodes, impl_->problem.boundary[alpha].dirichlet, impl_->problem.time);
      for (const auto& g : impl_->problem.boundary[alpha].dirichlet)
        if (g) size = std::max(size, g->cancelled());
      const auto first = before.impl_->data[alpha], last = after.impl_->data[alpha];
      for (std::size_t e = 0; e < d[alpha].size(); ++e) {
        size = std::max(size, std::abs(d[alpha][e]));
        d[alpha][e] -= 0.5 * (first(e) + last(e));
        most = std::max(most, std::abs(d[alpha][e]));
      }
    }
  });
  if (comm.max(most) <= 1e-13 * comm.max(size)) return {};
  const LocalIndex cells = space.mesh().owned_cells;
  Bulge bulge{View<double*>("thixis::bound::bulge_energy", cells), View<double* [2]>("thixis::bound::bulge_size", cells),
              CellTable("thixis::bound::bulge_gap", cells, n)};
  View<const double*> coefficients[2];
  for (int alpha = 0; alpha < count; ++alpha) coefficients[alpha] = to_view("thixis::bound::bulge", d[alpha]);
  const FeasibleParts kernel = impl_->kernel;
  const Matrix modal = impl_->modal;
  Kokkos::parallel_for(
      "thixis::bound::bulge", Kokkos::RangePolicy<>(0, cells), KOKKOS_LAMBDA(int K) {
        const mesh::CellGeometry geometry = mesh::cell_geometry(kernel.x, kernel.vertices, K);
        double square = 0;
        for (int alpha = 0; alpha < count; ++alpha) {
          double local[reference::max_functions], c[reference::max_functions], mass = 0;
          for (int l = 0; l < n; ++l) local[l] = coefficients[alpha](kernel.of_cells(K, l));
          kernel.functions.to_bernstein(local, c);
          square += kernel.energy(alpha, K, geometry, c);
          for (int m = 0; m < n; ++m) {
            double value = 0;
            for (int l = 0; l < n; ++l) value += modal(m, l) * local[l];
            mass += value * value;
            bulge.gap(K, m) += alpha == 0 ? value : -value;
          }
          bulge.size(K, alpha) = std::sqrt(2 * geometry.area * mass);
        }
        bulge.energy(K) = std::sqrt(square > 0 ? square : 0);
      });
  return bulge;
}

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
