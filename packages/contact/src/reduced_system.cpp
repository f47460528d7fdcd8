#include <algorithm>
#include <cmath>

#include "gap_rows.hpp"
#include "piece.hpp"
#include "thixis/contact/linearized_system.hpp"

namespace thixis::contact {
namespace {

using algebra::MultiVector;
using algebra::Vector;

/// An iterate of the linear solver: made at the first look, and kept for all others.
struct Shown {
  MultiVector dy;
  Vector dX;
  MultiVector du, dlambda;  ///< columns of dX

  explicit Shown(const System& system)
      : dy(system.map(), system.fields()),
        dX(map_of_all(system)),
        du(fields_nonconst(system, dX)),
        dlambda(multipliers_nonconst(system, dX)) {}
};

class ReducedSystem final : public LinearizedSystem {
 public:
  ReducedSystem(const System& system, const Weights& weights, const algebra::LinearParams& params, const algebra::Nodes& nodes,
                const Teuchos::RCP<MultiVector>& room)
      : system_(system),
        weights_(weights),
        operator_(system, room),
        gaps_(system),
        rhs_(system.map(), system.fields()),
        dy_(system.map(), system.fields()),
        force_(system.map(), system.fields()) {
    for (const Part& part : independent_parts(system))
      pieces_.emplace_back(system, part, make_constrained_solver(system, part, params, nodes), rhs_, dy_);
    gaps_.set_diagonal(operator_);
  }

  void renew() override {
    gaps_.set_diagonal(operator_);
    for (Piece& piece : pieces_) piece.ready = false;
  }

  void linearize(const Vector& a, const Vector& b) override {
    gaps_.decide(a, b);
    for (Piece& piece : pieces_) {
      if (!piece.has_gaps) continue;
      stretch(piece);
      piece.solver->set_matrix(piece.part, gaps_.contact(), gaps_.penalty());
    }
  }

  algebra::LinearReport solve(const Vector& R, Vector& dX, const algebra::LinearStop& stop) override {
    const MultiVector R_fields = fields(system_, R), C = multipliers(system_, R);
    gaps_.set_known(C, dy_);
    operator_.apply(dy_, rhs_);
    gaps_.set_right_sides(R_fields, C, dy_, rhs_);
    start(stop);
    algebra::LinearReport all;
    all.converged = true;
    for (Piece& piece : pieces_) {
      const auto report = solve(piece, R_fields, C, all.iterations, stop);
      all.iterations += report.iterations;
      all.by_criterion = all.by_criterion || report.by_criterion;
      all.converged = report.converged;
      all.reason = report.reason;
      if (!report.converged) break;
    }
    all.residual = total_residual();
    MultiVector du = fields_nonconst(system_, dX), dlambda = multipliers_nonconst(system_, dX);
    recover(R_fields, C, dy_, du, dlambda);
    return all;
  }

  /// R + S du - B D dlambda, from what the recovery of dlambda has left.
  bool residual_of_shown(const Vector& R, Vector& R_shown) const override {
    R_shown.putScalar(0);
    MultiVector rows = fields_nonconst(system_, R_shown);
    leave_frames(system_, force_, rows);
    rows.update(1, fields(system_, R), 1);
    subtract_pressure(system_, shown_->dlambda, rows);
    return true;
  }

  GlobalIndex nonzeros() const override {
    GlobalIndex sum = 0;
    for (const Piece& piece : pieces_) sum += piece.solver->nonzeros();
    return sum;
  }

 private:
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

  /// What each piece begins with; where somebody looks at iterates, also the residual that it has there.
  void start(const algebra::LinearStop& stop) {
    if (stop.criterion && !shown_) shown_ = std::make_unique<Shown>(system_);
    for (Piece& piece : pieces_) {
      if (!piece.has_gaps) stretch(piece);
      piece.take(rhs_, dy_);
      if (!piece.has_gaps) piece.residual = piece.weight * piece.rhs->norm2();
      else piece.residual = stop.criterion ? piece.weight * piece.solver->residual(*piece.rhs, *piece.y) : 0;
    }
  }

  algebra::LinearReport solve(Piece& piece, const MultiVector& R, const MultiVector& C, int before, const algebra::LinearStop& stop) {
    algebra::LinearReport report;
    report.converged = true;
    if (!piece.has_gaps && piece.residual <= share() * stop.tolerance) return report;
    if (!piece.has_gaps && !piece.ready) {
      const MultiVector none(system_.map(), system_.gaps());
      piece.solver->set_matrix(piece.part, none, none);
      piece.ready = true;
    }
    algebra::LinearStop inner = stop;
    inner.tolerance = share() * stop.tolerance / piece.weight;
    if (stop.criterion)
      inner.criterion = [&](const Vector& y, int i, double residual) {
        piece.residual = piece.weight * residual;
        Tpetra::deep_copy(shown_->dy, dy_);
        piece.put(y, shown_->dy);
        recover(R, C, shown_->dy, shown_->du, shown_->dlambda);
        return stop.criterion(shown_->dX, before + i, total_residual());
      };
    report = piece.solver->solve(*piece.rhs, *piece.y, inner);
    piece.residual = piece.weight * report.residual;
    if (piece.part.size > 1) piece.put(*piece.y, dy_);
    return report;
  }

  double total_residual() const {
    double sum = 0;
    for (const Piece& piece : pieces_) sum = std::hypot(sum, piece.residual);
    return sum;
  }

  /// du = T dy; dlambda = -(C + a dz)/b, at contact D dlambda = (Tᵀ R + Tᵀ S T dy)_z: one product with the operator.
  void recover(const MultiVector& R, const MultiVector& C, const MultiVector& dy, MultiVector& du, MultiVector& dlambda) {
    operator_.apply(dy, force_);
    apply_frames(system_, dy, du);
    gaps_.recover(R, C, dy, force_, dlambda);
  }

  const System& system_;
  const Weights& weights_;
  TransformedOperator operator_;
  GapRows gaps_;
  MultiVector rhs_, dy_;
  MultiVector force_;  ///< Tᵀ S T dy of the last recovery
  std::unique_ptr<Shown> shown_;
  std::vector<Piece> pieces_;
};

}  // namespace

std::unique_ptr<LinearizedSystem> make_reduced_system(const System& system, const Weights& weights, const algebra::LinearParams& params,
                                                      const algebra::Nodes& nodes, const Teuchos::RCP<MultiVector>& room) {
  return std::make_unique<ReducedSystem>(system, weights, params, nodes, room);
}

}  // namespace thixis::contact
