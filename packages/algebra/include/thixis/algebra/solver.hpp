#pragma once
#include <functional>
#include <memory>
#include <string>

#include "thixis/algebra/nodes.hpp"
#include "thixis/core/schema.hpp"

namespace thixis::algebra {

enum class SolverKind { gmres, cg, direct };
enum class SystemForm { full, reduced };
enum class PreconditionerKind { none, ilu, ilut, muelu, multigrid };

/// Block `linear` of the deck.
struct LinearParams {
  SolverKind solver = SolverKind::gmres;
  SystemForm form = SystemForm::full;
  PreconditionerKind preconditioner = PreconditionerKind::ilu;
  int ilu_level = 0;
  int overlap = 0;
  double ilut_fill = 2.0;
  int restart = 200;
  int max_iterations = 2000;
  int check_every = 10;
  static const core::Schema<LinearParams>& schema();
};

/// When a Krylov loop ends: at |b - A x| <= tolerance, or as soon as `criterion`, asked every `check_every` iterations (counted through
/// restarts), says so. It is asked once more, between, if the iterate can get no better because of rounding.
struct LinearStop {
  double tolerance = 0;  ///< absolute, Euclidean norm of the unpreconditioned residual
  int check_every = 0;   ///< 0: never ask
  /// (x^i, i, |b - A x^i|) -> stop now? Called on all ranks, which must agree; x^i is there during the call only. The residual is that of
  /// the Krylov recursion, equal to the true one up to rounding.
  std::function<bool(const Vector& x, int iteration, double residual)> criterion;
};

struct LinearReport {
  int iterations = 0;
  double residual = 0;     ///< |b - A x| at the end, computed from x; NaN if there is no finite iterate (x is then as it was)
  bool converged = false;  ///< the tolerance or the criterion was met
  bool by_criterion = false;
  bool shortened = false;  ///< by the model, after the solve: x is less than what solves the system
  std::string reason;      ///< one clause for the log when not converged
};

/// A x = b on all ranks. Symbolic work is done once per graph, numeric work at each `set_matrix`.
class Solver {
 public:
  explicit Solver(const LinearParams& params);
  ~Solver();
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  /// Takes the values of a matrix and sets up the preconditioner. Call it again after the values have changed.
  /// For multigrid: fields = unknowns per node, whose rows have the ids fields·node + 0, 1, ... and lie on one rank; the nodes, rows /
  /// fields of them in the same order. Without coordinates all levels of MueLu but the finest live on one rank; without levels below
  /// `multigrid` is MueLu. Both refuse zeros on the diagonal, MueLu torn nodes, by InputError; what else is wrong with the matrix shows in
  /// the reports of `solve`.
  void set_matrix(const Teuchos::RCP<const Matrix>& A, int fields, const Nodes& nodes = {});

  /// Starts from x and overwrites it. Throws InputError for a combination that can not work, never leaves NaN in x unnoticed.
  LinearReport solve(const Vector& b, Vector& x, const LinearStop& stop) const;

  double seconds_preconditioner() const;  ///< total time spent in set_matrix
  int symbolic_setups() const;            ///< how often a pattern was analysed: once per graph (muelu, overlapping ilu: at each set_matrix)
 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace thixis::algebra
