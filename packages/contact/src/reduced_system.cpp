#include <algorithm>
#include <cmath>
#include <numeric>

#include "constrained_solver.hpp"
#include "thixis/contact/linearized_system.hpp"

namespace thixis::contact {
namespace {

using algebra::MultiVector;
using algebra::Vector;
using Range = Kokkos::RangePolicy<algebra::Matrix::execution_space>;

constexpr double contact_ratio = 1e10;

auto read(const MultiVector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadOnly); }
auto change(MultiVector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadWrite); }

/// Coordinates that act on each other, directly or through others. Blocks that are nothing but rounding do not count.
std::vector<Part> independent_parts(const System& system) {
  const int m = system.fields();
  const TransformedBlocks blocks(system, all_coordinates(m));
  if (!blocks.frames.uniform()) return {all_coordinates(m)};
  const auto act = [&](int i, int j) {
    for (int k = 0; k < blocks.matrices; ++k) {
      const double size = std::sqrt(std::abs(blocks.uniform[k](i, i) * blocks.uniform[k](j, j)));
      for (const double c : {blocks.uniform[k](i, j), blocks.uniform[k](j, i)})
        if (std::abs(c) > 1e-13 * size) return true;
    }
    return false;
  };
  std::vector<int> root(m);
  std::iota(root.begin(), root.end(), 0);
  for (int pass = 0; pass < m; ++pass)
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < m; ++j)
        if (act(i, j)) root[i] = root[j] = std::min(root[i], root[j]);
  std::vector<Part> parts;
  for (int r = 0; r < m; ++r) {
    Part part;
    for (int i = 0; i < m; ++i)
      if (root[i] == r) part.coordinate[part.size++] = i;
    if (part.size > 0) parts.push_back(part);
  }
  return parts;
}

/// One of them, with its solver and its vectors.
struct Piece {
  Part part;
  bool has_gaps;
  bool ready = false;  ///< the matrix is that of the operator
  std::unique_ptr<ConstrainedSolver> solver;
  Teuchos::RCP<Vector> rhs, y;
  double weight = 1;    ///< of a residual of this system
  double residual = 0;  ///< the last known one, weighted
};

class ReducedSystem final : public LinearizedSystem {
 public:
  ReducedSystem(const System& system, const Weights& weights, const algebra::LinearParams& params,
                const Teuchos::RCP<const MultiVector>& coordinates)
      : system_(system),
        weights_(weights),
        means_(system.fields() - system.gaps()),
        operator_(system),
        diagonal_(system.map(), system.gaps()),
        contact_(system.map(), system.gaps()),
        penalty_(system.map(), system.gaps()),
        r_(system.map(), system.fields()),
        rhs_(system.map(), system.fields()),
        dy_(system.map(), system.fields()),
        force_(system.map(), system.gaps()),
        a_(map_of_gaps(system)),
        b_(map_of_gaps(system)),
        look_(map_of_all(system)) {
    for (const Part& part : independent_parts(system)) {
      const auto map = algebra::interlaced(system.map(), part.size);
      pieces_.push_back({part, part.coordinate[part.size - 1] >= means_, false, make_constrained_solver(system, part, params, coordinates),
                         Teuchos::rcp(new Vector(map)), Teuchos::rcp(new Vector(map))});
    }
    operator_.diagonal(means_, diagonal_);
  }

  void renew() override {
    operator_.diagonal(means_, diagonal_);
    for (Piece& piece : pieces_) piece.ready = false;
  }

  void linearize(const Vector& a, const Vector& b) override {
    a_.assign(a);
    b_.assign(b);
    decide_contact();
    for (Piece& piece : pieces_) {
      if (!piece.has_gaps) continue;
      stretch(piece);
      piece.solver->set_matrix(piece.part, contact_, penalty_);
    }
  }

  algebra::LinearReport solve(const Vector& R, Vector& dX, const algebra::LinearStop& stop) override {
    transpose_frames(system_, fields(system_, R), r_);
    const MultiVector C = gaps_of(R);
    set_right_sides(C);
    start(stop);
    algebra::LinearReport all;
    all.converged = true;
    for (Piece& piece : pieces_) {
      const auto report = solve(piece, C, all.iterations, stop);
      all.iterations += report.iterations;
      all.by_criterion = all.by_criterion || report.by_criterion;
      all.converged = report.converged;
      all.reason = report.reason;
      if (!report.converged) break;
    }
    all.residual = total_residual();
    recover(C, dy_, dX);
    return all;
  }

  GlobalIndex nonzeros() const override {
    GlobalIndex sum = 0;
    for (const Piece& piece : pieces_) sum += piece.solver->nonzeros();
    return sum;
  }

 private:
  MultiVector gaps_of(const Vector& R) const { return multipliers(system_, R); }
  double share() const { return pieces_.size() == 1 && pieces_[0].part.size == 1 ? 1 : 0.8 / system_.fields(); }

  /// The weight of a residual of a coordinate: R = T^{-T} r, R_a = sum_i T^{-1}(i, a) r_i.
  double weight_of(int coordinate) const {
    const auto inverse = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), system_.constraint.frames.inverse);
    double weight = 0;
    for (std::size_t kind = 0; kind < inverse.extent(0); ++kind)
      for (int a = 0; a < system_.fields(); ++a)
        weight = std::max(weight, weights_.field[a] * std::min(1.0, 2 * std::abs(inverse(kind)(coordinate, a))));
    return weight;
  }

  /// So that all unknowns of a piece are solved as well as they must be. Powers of two round nothing, and what acts now alone decides.
  void stretch(Piece& piece) const {
    piece.weight = 0;
    const double first = weight_of(piece.part.coordinate[0]);
    for (int i = 0; i < piece.part.size; ++i) {
      const double weight = weight_of(piece.part.coordinate[i]);
      piece.part.stretch[i] = std::exp2(std::round(std::log2(weight / first)));
      piece.weight = std::max(piece.weight, weight / piece.part.stretch[i]);
    }
  }

  void decide_contact() {
    const auto D = read(*system_.constraint.pairing), diagonal = read(diagonal_);
    const MultiVector a_gaps = gaps(system_, a_), b_gaps = gaps(system_, b_);
    const auto a = read(a_gaps), b = read(b_gaps);
    contact_.putScalar(0);
    penalty_.putScalar(0);
    const auto contact = change(contact_), penalty = change(penalty_);
    const auto node = system_.constraint.node;
    const int q = system_.gaps();
    Kokkos::parallel_for(
        "thixis::contact::contact", Range(0, a.extent_int(0)), KOKKOS_LAMBDA(int p) {
          const LocalIndex l = node(p);
          for (int g = 0; g < q; ++g) {
            const double held = D(p, 0) * a(p, g), flexible = contact_ratio * diagonal(l, g) * b(p, g);
            const bool closed = held * held >= flexible * flexible;
            contact(l, g) = closed ? 1 : 0;
            penalty(l, g) = closed ? 0 : D(p, 0) * a(p, g) / b(p, g);
          }
        });
  }

  /// dy_ <- the known gaps; rhs_ <- -r - Tᵀ S T dy, in rows of gaps: diag·known at contact, - D C/b at free points.
  void set_right_sides(const MultiVector& C) {
    dy_.putScalar(0);
    const auto c = read(C), D = read(*system_.constraint.pairing), contact = read(contact_), diagonal = read(diagonal_);
    const MultiVector a_gaps = gaps(system_, a_), b_gaps = gaps(system_, b_);
    const auto a = read(a_gaps), b = read(b_gaps);
    const auto node = system_.constraint.node;
    const int q = system_.gaps(), means = means_;
    {
      const auto known = change(dy_);
      Kokkos::parallel_for(
          "thixis::contact::known_gaps", Range(0, c.extent_int(0)), KOKKOS_LAMBDA(int p) {
            const LocalIndex l = node(p);
            for (int g = 0; g < q; ++g) known(l, means + g) = contact(l, g) > 0 ? -c(p, g) / a(p, g) : 0;
          });
    }
    operator_.apply(dy_, 0, rhs_);
    rhs_.update(-1, r_, -1);
    const auto known = read(dy_);
    const auto out = change(rhs_);
    Kokkos::parallel_for(
        "thixis::contact::right_side_of_gaps", Range(0, c.extent_int(0)), KOKKOS_LAMBDA(int p) {
          const LocalIndex l = node(p);
          for (int g = 0; g < q; ++g) {
            if (contact(l, g) > 0) out(l, means + g) = diagonal(l, g) * known(l, means + g);
            else out(l, means + g) -= D(p, 0) * c(p, g) / b(p, g);
          }
        });
  }

  /// What each piece begins with; where somebody looks at iterates, also the residual that it has there.
  void start(const algebra::LinearStop& stop) {
    for (Piece& piece : pieces_) {
      take(piece, rhs_, *piece.rhs, true);
      take(piece, dy_, *piece.y, false);
      if (!piece.has_gaps) {
        stretch(piece);
        piece.residual = piece.weight * piece.rhs->norm2();
      } else {
        piece.residual = stop.criterion ? piece.weight * piece.solver->residual(*piece.rhs, *piece.y) : 0;
      }
    }
  }

  algebra::LinearReport solve(Piece& piece, const MultiVector& C, int before, const algebra::LinearStop& stop) {
    algebra::LinearReport report;
    report.converged = true;
    if (!piece.has_gaps && piece.residual <= share() * stop.tolerance) return report;
    if (!piece.has_gaps && !piece.ready) {
      contact_none_.reset(new MultiVector(system_.map(), system_.gaps()));
      piece.solver->set_matrix(piece.part, *contact_none_, *contact_none_);
      piece.ready = true;
    }
    algebra::LinearStop inner = stop;
    inner.tolerance = share() * stop.tolerance / piece.weight;
    if (stop.criterion)
      inner.criterion = [&](const Vector& y, int i, double residual) {
        piece.residual = piece.weight * residual;
        put(piece, y);
        recover(C, dy_, look_);
        return stop.criterion(look_, before + i, total_residual());
      };
    report = piece.solver->solve(*piece.rhs, *piece.y, inner);
    piece.residual = piece.weight * report.residual;
    put(piece, *piece.y);
    return report;
  }

  double total_residual() const {
    double sum = 0;
    for (const Piece& piece : pieces_) sum = std::hypot(sum, piece.residual);
    return sum;
  }

  /// Unknowns of a piece out of columns of coordinates: right-hand sides are multiplied by the stretch, unknowns divided.
  void take(const Piece& piece, const MultiVector& columns, Vector& out, bool right_side) const {
    const auto in = read(columns);
    const auto to = out.getLocalViewDevice(Tpetra::Access::OverwriteAll);
    const Part part = piece.part;
    Kokkos::parallel_for(
        "thixis::contact::take", Range(0, in.extent_int(0)), KOKKOS_LAMBDA(int l) {
          for (int i = 0; i < part.size; ++i)
            to(part.size * l + i, 0) =
                right_side ? part.stretch[i] * in(l, part.coordinate[i]) : in(l, part.coordinate[i]) / part.stretch[i];
        });
  }

  void put(const Piece& piece, const Vector& y) {
    const auto in = read(y);
    const auto to = change(dy_);
    const Part part = piece.part;
    Kokkos::parallel_for(
        "thixis::contact::put", Range(0, to.extent_int(0)), KOKKOS_LAMBDA(int l) {
          for (int i = 0; i < part.size; ++i) to(l, part.coordinate[i]) = part.stretch[i] * in(part.size * l + i, 0);
        });
  }

  /// du = T dy; dlambda = -(C + a dz)/b, at contact D dlambda = (r + Tᵀ S T dy)_z: one product with the operator.
  void recover(const MultiVector& C, const MultiVector& dy, Vector& dX) {
    operator_.apply(dy, means_, force_);
    MultiVector du = fields_nonconst(system_, dX), dlambda = multipliers_nonconst(system_, dX);
    apply_frames(system_, dy, du);
    const auto c = read(C), z = read(dy), r = read(r_), pushed = read(force_), D = read(*system_.constraint.pairing),
               contact = read(contact_);
    const MultiVector a_gaps = gaps(system_, a_), b_gaps = gaps(system_, b_);
    const auto a = read(a_gaps), b = read(b_gaps);
    const auto out = change(dlambda);
    const auto node = system_.constraint.node;
    const int q = system_.gaps(), means = means_;
    Kokkos::parallel_for(
        "thixis::contact::recover", Range(0, out.extent_int(0)), KOKKOS_LAMBDA(int p) {
          const LocalIndex l = node(p);
          for (int g = 0; g < q; ++g)
            out(p, g) = contact(l, g) > 0 ? (pushed(l, g) + r(l, means + g)) / D(p, 0) : -(c(p, g) + a(p, g) * z(l, means + g)) / b(p, g);
        });
  }

  const System& system_;
  const Weights& weights_;
  int means_;
  TransformedOperator operator_;
  MultiVector diagonal_;  ///< of the rows of gaps
  MultiVector contact_;   ///< 1 at contact, else 0
  MultiVector penalty_;   ///< D a/b at free gaps, else 0
  MultiVector r_, rhs_, dy_, force_;
  Vector a_, b_, look_;
  std::unique_ptr<MultiVector> contact_none_;
  std::vector<Piece> pieces_;
};

}  // namespace

std::unique_ptr<LinearizedSystem> make_reduced_system(const System& system, const Weights& weights, const algebra::LinearParams& params,
                                                      const Teuchos::RCP<const MultiVector>& coordinates) {
  return std::make_unique<ReducedSystem>(system, weights, params, coordinates);
}

}  // namespace thixis::contact
