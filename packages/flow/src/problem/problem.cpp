#include "problem/problem.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "problem/increments.hpp"
#include "step/turnover.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::flow {
namespace {

using algebra::Vector;
using Cells = Kokkos::RangePolicy<Vector::execution_space>;
using LocalMatrix = algebra::Matrix::local_matrix_device_type;
using In = decltype(std::declval<const Vector&>().getLocalViewDevice(Tpetra::Access::ReadOnly));
using Out = decltype(std::declval<Vector&>().getLocalViewDevice(Tpetra::Access::ReadWrite));

constexpr int contact_row = 0, first_equation = 1;
constexpr double some_gas = 1e-8;        // s_g of cells that can give and take water
constexpr double rounding = 1e-15;       // mean row that needs no correction
constexpr double singular = 1e-10;       // share of the determinant that cancellation must leave
constexpr double largest_weight = 1e60;  // nothing overflows
constexpr int most_sharpenings = 4;
constexpr double small_part = 1e-3;          // of the largest increment, that a row may leave in its unknown
constexpr double smallest_increment = 1e-4;  // in the units of the unknowns, that counts
constexpr double resolved = 1e10;            // units in the last place that a step must move for its tolerance to be relative to them

In read(const Vector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadOnly); }
Out write(Vector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadWrite); }

/// The faces around a cell, their areas with the sign of outward fluxes, and the factors tau/(|K| mass_c) of its equations.
struct Around {
  fv::View<LocalIndex*> begin, faces;
  fv::View<LocalIndex* [2]> cells;
  fv::View<double*> area, volume;
  double length, mass[components];

  Around(const fv::Grid& grid, double step_length, const FlowScales& scales)
      : begin(grid.cell_face_begin),
        faces(grid.cell_faces),
        cells(grid.face_cells),
        area(grid.face_area),
        volume(grid.volume),
        length(step_length),
        mass{scales.mass[0], scales.mass[1]} {}
  KOKKOS_FUNCTION bool first(LocalIndex F, LocalIndex K) const { return cells(F, 0) == K; }
  KOKKOS_FUNCTION double outward(LocalIndex F, LocalIndex K) const { return first(F, K) ? area(F) : -area(F); }
};

struct Equations {
  Around around;
  TwoPhaseLaws laws;
  fv::View<PhaseState*> states;
  fv::View<FaceFlux*> fluxes;
  fv::View<double*[components]> before, owed, source;
  Out R;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex K) const {
    const Masses l = laws.masses(states(K));
    double out[components] = {0, 0};
    for (LocalIndex f = around.begin(K); f < around.begin(K + 1); ++f) {
      const LocalIndex F = around.faces(f);
      for (int c = 0; c < components; ++c) out[c] += around.outward(F, K) * fluxes(F).value[c];
    }
    R(unknowns_per_cell * K + contact_row, 0) = 0;
    for (int c = 0; c < components; ++c)
      R(unknowns_per_cell * K + first_equation + c, 0) =
          (l.value[c] - before(K, c) + owed(K, c) + around.length * (out[c] / around.volume(K) - source(K, c))) / around.mass[c];
  }
};

/// |F|² over the owned cells.
struct Reference {
  Around around;
  double rock_filled;  ///< phi rho_w: the masses of water are counted from it
  fv::View<double*[components]> before, source, inflow;

  KOKKOS_FUNCTION void operator()(LocalIndex K, double& sum) const {
    for (int c = 0; c < components; ++c) {
      double in = 0;
      for (LocalIndex f = around.begin(K); f < around.begin(K + 1); ++f)
        if (around.cells(around.faces(f), 1) < 0) in += around.area(around.faces(f)) * inflow(around.faces(f), c);
      const double l = before(K, c) + (c == water ? rock_filled : 0);
      const double F = (l + around.length * (source(K, c) + in / around.volume(K))) / around.mass[c];
      sum += F * F;
    }
  }
};

struct Fill {
  Around around;
  TwoPhaseLaws laws;
  double unknown[unknowns_per_cell];
  fv::View<PhaseState*> states;
  fv::View<FaceFlux*> fluxes;
  fv::View<LocalIndex*> row_begin, own, place;
  In a, b;
  LocalMatrix A;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex K) const {
    const LocalIndex contact = row_begin(K), equations = contact + unknowns_per_cell;
    const LocalIndex row = (row_begin(K + 1) - equations) / components;  // entries of each equation
    for (LocalIndex k = equations; k < row_begin(K + 1); ++k) A.values(k) = 0;

    double G[unknowns_per_cell];
    laws.undersaturation_slopes(states(K), G);
    for (int u = 0; u < unknowns_per_cell; ++u) A.values(contact + u) = unknown[u] * (b(K, 0) * G[u] + (u == gas_saturation ? a(K, 0) : 0));

    const Masses l = laws.masses(states(K));
    for (int c = 0; c < components; ++c) {
      double* entries = &A.values(equations + c * row);
      double* diagonal = entries + unknowns_per_cell * own(K);
      for (int u = 0; u < unknowns_per_cell; ++u) diagonal[u] = unknown[u] * l.d[c][u] / around.mass[c];
      const double factor = around.length / (around.volume(K) * around.mass[c]);
      for (LocalIndex f = around.begin(K); f < around.begin(K + 1); ++f) {
        const LocalIndex F = around.faces(f);
        const FaceFlux& flux = fluxes(F);
        const double out = factor * around.outward(F, K);
        const auto& by_own = around.first(F, K) ? flux.by_first : flux.by_second;
        const auto& by_other = around.first(F, K) ? flux.by_second : flux.by_first;
        for (int u = 0; u < unknowns_per_cell; ++u) diagonal[u] += unknown[u] * out * by_own[c][u];
        if (place(f) >= 0)
          for (int u = 0; u < unknowns_per_cell; ++u) entries[unknowns_per_cell * place(f) + u] = unknown[u] * out * by_other[c][u];
      }
    }
  }
};

/// W^T v over the owned cells: the rows of water and of hydrogen summed with the weights |K|, masses over mass_c.
std::array<double, components> summed(const fv::Grid& grid, const Vector& v) {
  std::array<double, components> sum;
  const auto volume = grid.volume;
  const auto in = read(v);
  for (int c = 0; c < components; ++c)
    Kokkos::parallel_reduce(
        "thixis::flow::summed", Cells(0, grid.owned_cells),
        KOKKOS_LAMBDA(LocalIndex K, double& of) { of += volume(K) * in(unknowns_per_cell * K + first_equation + c, 0); }, sum[c]);
  return sum;
}

Teuchos::RCP<algebra::MultiVector> coordinates_of(const TwoPhaseOperator& flow) {
  const fv::Grid& grid = flow.grid();
  const auto coordinates = Teuchos::rcp(new algebra::MultiVector(flow.cells(), grid.dimension));
  const auto x = coordinates->getLocalViewDevice(Tpetra::Access::OverwriteAll);
  const auto centre = grid.centre;
  const int dimension = grid.dimension;
  Kokkos::parallel_for(
      "thixis::flow::coordinates", Cells(0, grid.owned_cells), KOKKOS_LAMBDA(LocalIndex K) {
        for (int i = 0; i < dimension; ++i) x(K, i) = centre(K, i);
      });
  return coordinates;
}

}  // namespace

FlowScales::FlowScales(const TwoPhaseLaws& laws, double P_ref)
    : pressure(P_ref), mass{laws.porosity * laws.rho_w, laws.porosity * laws.H * P_ref}, unknown{1, P_ref, laws.H * P_ref / laws.beta_l} {}

TwoPhaseProblem::TwoPhaseProblem(const TwoPhaseOperator& flow, const FlowScales& scales, const algebra::LinearParams& params,
                                 Teuchos::RCP<const Vector> origin)
    : flow_(flow), scales_(scales), origin_(std::move(origin)), coordinates_(coordinates_of(flow)), solver_(params) {
  int faces = 0;
  const auto& kind = flow.face_kind();
  Kokkos::parallel_reduce(
      "thixis::flow::open", Cells(0, flow.grid().faces),
      KOKKOS_LAMBDA(LocalIndex F, int& sum) { sum += kind(F) == FlowBoundaryKind::state; }, faces);
  const auto volume = flow.grid().volume;
  Kokkos::parallel_reduce(
      "thixis::flow::volume", Cells(0, flow.grid().owned_cells), KOKKOS_LAMBDA(LocalIndex K, double& sum) { sum += volume(K); }, volume_);
  volume_ = flow.grid().comm.sum(volume_);
  open_ = !flow.grid().comm.all(faces == 0);
}

FlowScales TwoPhaseProblem::row_scales() const {
  FlowScales scales = scales_;
  for (int c = 0; c < components; ++c) scales.mass[c] /= weight_[c];
  return scales;
}

/// w_c = |l^{n-1}|/moved_c where that is more than 1; of water, of which there is plenty, no more than of hydrogen.
void TwoPhaseProblem::set_weights(double in_place) {
  const Turnover of = turnover(flow_, step_);
  double moved[components], rounding[components];
  for (int c = 0; c < components; ++c) {
    moved[c] = of.moved[c] / scales_.mass[c];
    rounding[c] = of.rounding[c] / scales_.mass[c];
  }
  moved[water] = std::max(moved[water], moved[hydrogen]);
  for (int c = 0; c < components; ++c) {
    const double counts = std::max(moved[c], resolved * rounding[c]);
    weight_[c] = counts > 0 ? std::clamp(in_place / counts, 1.0, largest_weight) : 1;
  }
  round_off_ = weight_[water] * rounding[water];
}

void TwoPhaseProblem::begin(FlowStep step) {
  step_ = std::move(step);
  at_ = {};
  reference_norm_ = brought_norm(step_.length);
  set_weights(brought_norm(0));
}

/// |F| of a step of this length.
double TwoPhaseProblem::brought_norm(double length) const {
  double sum = 0;
  Kokkos::parallel_reduce("thixis::flow::reference", Cells(0, flow_.grid().owned_cells),
                          Reference{Around(flow_.grid(), length, scales_), flow_.laws().porosity * flow_.laws().rho_w, step_.before,
                                    step_.source, step_.inflow},
                          sum);
  return std::sqrt(flow_.grid().comm.sum(sum));
}

void TwoPhaseProblem::equations(const Vector& X, Vector& R) const {
  const auto states = flow_.states(X);
  Equations kernel{Around(flow_.grid(), step_.length, row_scales()), flow_.laws()};
  kernel.states = states;
  kernel.fluxes = flow_.fluxes(states, step_);
  kernel.before = step_.before;
  kernel.owed = step_.owed;
  kernel.source = step_.source;
  kernel.R = write(R);
  Kokkos::parallel_for("thixis::flow::equations", Cells(0, flow_.grid().owned_cells), kernel);
}

fv::View<double* [components]> TwoPhaseProblem::left(const Vector& X) const {
  Vector R(flow_.map());
  equations(X, R);
  const auto r = read(R);
  const FlowScales scales = row_scales();
  const fv::View<double* [components]> left("thixis::flow::left", flow_.grid().owned_cells);
  Kokkos::parallel_for(
      "thixis::flow::left", Cells(0, flow_.grid().owned_cells), KOKKOS_LAMBDA(LocalIndex K) {
        for (int c = 0; c < components; ++c) left(K, c) = scales.mass[c] * r(unknowns_per_cell * K + first_equation + c, 0);
      });
  return left;
}

void TwoPhaseProblem::arguments(const Vector& X, Vector& K, Vector& G) const {
  const auto x = read(X);
  const auto gap = write(K), undersaturation = write(G);
  const TwoPhaseLaws laws = flow_.laws();
  Kokkos::parallel_for(
      "thixis::flow::arguments", Cells(0, flow_.grid().owned_cells), KOKKOS_LAMBDA(LocalIndex i) {
        const LocalIndex k = unknowns_per_cell * i;
        gap(i, 0) = x(k + gas_saturation, 0);
        undersaturation(i, 0) = laws.undersaturation(laws.state(x(k, 0), x(k + 1, 0), x(k + 2, 0)));
      });
}

void TwoPhaseProblem::scaling(Vector& s) const { s.putScalar(1 / (flow_.laws().H * scales_.pressure)); }

void TwoPhaseProblem::insert(const Vector& C, Vector& R) const {
  const auto c = read(C);
  const auto r = write(R);
  Kokkos::parallel_for(
      "thixis::flow::insert", Cells(0, c.extent_int(0)),
      KOKKOS_LAMBDA(LocalIndex K) { r(unknowns_per_cell * K + contact_row, 0) = c(K, 0); });
}

/// The rows of a cell hold itself and its neighbours across faces; that of contact itself alone.
void TwoPhaseProblem::set_pattern() {
  const fv::Grid& grid = flow_.grid();
  const auto host = [](const auto& view) { return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view); };
  const auto face_begin = host(grid.cell_face_begin), faces = host(grid.cell_faces);
  const auto cells = host(grid.face_cells);
  row_begin_ = fv::View<LocalIndex*>("thixis::flow::row_begin", grid.owned_cells + 1);
  own_ = fv::View<LocalIndex*>("thixis::flow::own", grid.owned_cells);
  place_ = fv::View<LocalIndex*>("thixis::flow::place", grid.cell_faces.extent(0));
  const auto row_begin = Kokkos::create_mirror_view(row_begin_), own = Kokkos::create_mirror_view(own_),
             place = Kokkos::create_mirror_view(place_);

  std::vector<LocalIndex> entries, group;
  std::vector<std::size_t> rows = {0};
  row_begin(0) = 0;
  for (LocalIndex K = 0; K < grid.owned_cells; ++K) {
    const auto neighbour = [&](LocalIndex f) { return cells(faces(f), 0) == K ? cells(faces(f), 1) : cells(faces(f), 0); };
    group = {K};
    for (LocalIndex f = face_begin(K); f < face_begin(K + 1); ++f)
      if (neighbour(f) >= 0) group.push_back(neighbour(f));
    std::sort(group.begin(), group.end());
    const auto found = [&](LocalIndex L) { return static_cast<LocalIndex>(std::find(group.begin(), group.end(), L) - group.begin()); };
    own(K) = found(K);
    for (LocalIndex f = face_begin(K); f < face_begin(K + 1); ++f) place(f) = neighbour(f) < 0 ? -1 : found(neighbour(f));

    const auto add_row = [&](const std::vector<LocalIndex>& of_cells) {
      for (const LocalIndex L : of_cells)
        for (int u = 0; u < unknowns_per_cell; ++u) entries.push_back(unknowns_per_cell * L + u);
      rows.push_back(entries.size());
    };
    add_row({K});
    for (int c = 0; c < components; ++c) add_row(group);
    row_begin(K + 1) = static_cast<LocalIndex>(entries.size());
  }
  Kokkos::deep_copy(row_begin_, row_begin);
  Kokkos::deep_copy(own_, own);
  Kokkos::deep_copy(place_, place);

  using LocalGraph = algebra::Graph::local_graph_device_type;
  const LocalGraph::row_map_type::non_const_type row_map("thixis::flow::row_map", rows.size());
  const LocalGraph::entries_type::non_const_type columns("thixis::flow::entries", entries.size());
  const auto host_rows = Kokkos::create_mirror_view(row_map);
  const auto host_columns = Kokkos::create_mirror_view(columns);
  std::copy(rows.begin(), rows.end(), host_rows.data());
  std::copy(entries.begin(), entries.end(), host_columns.data());
  Kokkos::deep_copy(row_map, host_rows);
  Kokkos::deep_copy(columns, host_columns);
  A_ = Teuchos::rcp(new algebra::Matrix(algebra::make_graph(flow_.map(), flow_.column_map(), row_map, columns)));
  A_->fillComplete();
}

void TwoPhaseProblem::linearize(const Vector& X, const Vector& a, const Vector& b) {
  const core::Region region("assembly");
  if (A_.is_null()) set_pattern();
  at_.X = Teuchos::rcp(new Vector(X, Teuchos::Copy));
  at_.states = flow_.states(X);
  at_.fluxes = flow_.fluxes(at_.states, step_);
  Fill kernel{Around(flow_.grid(), step_.length, row_scales()), flow_.laws()};
  for (int u = 0; u < unknowns_per_cell; ++u) kernel.unknown[u] = scales_.unknown[u];
  kernel.states = at_.states;
  kernel.fluxes = at_.fluxes;
  kernel.row_begin = row_begin_;
  kernel.own = own_;
  kernel.place = place_;
  kernel.a = read(a);
  kernel.b = read(b);
  kernel.A = A_->getLocalMatrixDevice();
  Kokkos::parallel_for("thixis::flow::jacobian", Cells(0, flow_.grid().owned_cells), kernel);
  solver_.set_matrix(A_, unknowns_per_cell, coordinates_);
}

/// X <- D X, or D^{-1} X; D holds the scales of the unknowns.
void TwoPhaseProblem::scale(Vector& X, bool up) const {
  const auto x = write(X);
  double factor[unknowns_per_cell];
  for (int u = 0; u < unknowns_per_cell; ++u) factor[u] = up ? scales_.unknown[u] : 1 / scales_.unknown[u];
  Kokkos::parallel_for(
      "thixis::flow::scale", Cells(0, flow_.grid().owned_cells), KOKKOS_LAMBDA(LocalIndex K) {
        for (int u = 0; u < unknowns_per_cell; ++u) x(unknowns_per_cell * K + u, 0) *= factor[u];
      });
}

algebra::LinearReport TwoPhaseProblem::solve(const Vector& R, Vector& dX, const algebra::LinearStop& stop) {
  Vector minus_R(R, Teuchos::Copy);
  minus_R.scale(-1);
  algebra::LinearStop scaled = stop;
  if (stop.criterion)
    scaled.criterion = [&](const Vector& y, int iteration, double residual) {
      Vector x(y, Teuchos::Copy);
      scale(x, true);
      return stop.criterion(x, iteration, residual);
    };
  dX.putScalar(0);
  algebra::LinearReport report = solver_.solve(minus_R, dX, scaled);
  if (report.converged) {
    sharpen(minus_R, dX, report);
    balance(minus_R, dX, report.residual);
  }
  scale(dX, true);
  report.shortened = shortened(flow_.laws(), scales_.unknown, *at_.X, dX);
  return report;
}

/// Rows of gas that flows easily are larger by orders of magnitude than others, which a tolerance in |.| then does not see: the solver is
/// asked for less until what any row leaves is small beside the increments.
void TwoPhaseProblem::sharpen(const Vector& B, Vector& Y, algebra::LinearReport& report) const {
  Vector r(B.getMap());
  for (int again = 0; again < most_sharpenings; ++again) {
    A_->apply(Y, r);
    r.update(1, B, -1);
    const double allowed = small_part * std::max(Y.normInf(), smallest_increment), left = largest_left(*A_, r);
    if (!(left > allowed)) return;
    algebra::LinearStop stop;
    stop.tolerance = std::min(0.1, 0.3 * allowed / left) * r.norm2();
    const algebra::LinearReport more = solver_.solve(B, Y, stop);
    report.iterations += more.iterations;
    if (std::isfinite(more.residual)) report.residual = more.residual;
    if (!more.converged) return;
  }
}

/// The column of Z for a component: chi for hydrogen; for water P if it can leave through faces of kind state, else s_g where there is gas.
Teuchos::RCP<Vector> TwoPhaseProblem::balancing_mode(int component) const {
  const auto mode = Teuchos::rcp(new Vector(flow_.map()));
  const auto z = write(*mode);
  const auto states = at_.states;
  const int unknown = component == hydrogen ? dissolved : open_ ? pressure : gas_saturation;
  Kokkos::parallel_for(
      "thixis::flow::balancing_mode", Cells(0, flow_.grid().owned_cells), KOKKOS_LAMBDA(LocalIndex K) {
        if (unknown != gas_saturation || states(K).s_g > some_gas) z(unknowns_per_cell * K + unknown, 0) = 1;
      });
  return mode;
}

/// Y <- Y + Z c with W^T (B - A Y) = 0. What the solver left, residual, becomes |B - A Y|; both stay as they are where the 2x2 system is
/// nearly singular, and where the residual would grow so much that a step of Newton's method could suffer.
void TwoPhaseProblem::balance(const Vector& B, Vector& Y, double& residual) const {
  const core::Region region("balance");
  const fv::Grid& grid = flow_.grid();
  Vector r(B, Teuchos::Copy);
  A_->apply(Y, r, Teuchos::NO_TRANS, -1, 1);
  const Teuchos::RCP<const Vector> Z[components] = {balancing_mode(water), balancing_mode(hydrogen)};
  Vector AZ[components] = {Vector(flow_.map()), Vector(flow_.map())};
  std::vector<double> sum;  // of the columns of A Z, and of r
  for (const Vector* v : {&AZ[water], &AZ[hydrogen], &r}) {
    if (v != &r) A_->apply(*Z[v - AZ], AZ[v - AZ]);
    const auto of = summed(grid, *v);
    sum.insert(sum.end(), of.begin(), of.end());
  }
  grid.comm.sum(sum);

  if (std::max(std::abs(sum[4]), std::abs(sum[5])) <= rounding * volume_) return;
  const double plus = sum[0] * sum[3], minus = sum[1] * sum[2], determinant = plus - minus;
  if (!(std::abs(determinant) > singular * (std::abs(plus) + std::abs(minus)))) return;
  const double c[components] = {(sum[4] * sum[3] - sum[5] * sum[2]) / determinant, (sum[0] * sum[5] - sum[1] * sum[4]) / determinant};
  const double before = r.norm2();
  r.update(-c[water], AZ[water], -c[hydrogen], AZ[hydrogen], 1);
  const double after = r.norm2();
  if (!(after <= std::max(2 * before, 0.5 * B.norm2()))) return;
  Y.update(c[water], *Z[water], c[hydrogen], *Z[hydrogen], 1);
  residual = after;
}

double TwoPhaseProblem::rhs_norm(const Vector& X, const Vector& R) const {
  Vector Y(X, Teuchos::Copy), B(R, Teuchos::Copy);
  Y.update(-1, *origin_, 1);
  scale(Y, false);
  A_->apply(Y, B, Teuchos::NO_TRANS, 1, -1);
  return B.norm2();
}

GlobalIndex TwoPhaseProblem::nonzeros() const { return A_.is_null() ? 0 : static_cast<GlobalIndex>(A_->getGlobalNumEntries()); }

}  // namespace thixis::flow
