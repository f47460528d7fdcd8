#pragma once
#include <functional>
#include <optional>
#include <string>

#include "thixis/complementarity/newton.hpp"
#include "thixis/drive/effort.hpp"
#include "thixis/drive/params.hpp"
#include "thixis/models/evolution.hpp"

namespace thixis::drive {

/// How far a run in time has come, with what all steps took.
struct TimePosition : Effort {
  int step = 0;     ///< accepted steps n
  double time = 0;  ///< t_n, in the unit of the deck
  int retries = 0;  ///< attempts that were given up
};

/// The step that was accepted, or the initial state (step 0).
struct StepRecord {
  TimePosition at;
  double length = 0;
  int newton = 0, linear = 0;  ///< of this step: of its last attempt
  std::optional<long long> active;
  std::optional<double> residual, energy_error;      ///< the error so far
  std::optional<complementarity::Estimate> of_step;  ///< where the error is estimated
  std::optional<complementarity::Estimate> so_far;
  double seconds = 0;  ///< wall clock of the step with its attempts
};

/// Who follows a run in time; functions may be empty. Called on all ranks with equal values.
struct EvolutionObserver {
  /// Within step n = at.step + 1, which ends at `end`; `error`: of the step, where its estimate was computed and the solution is known.
  std::function<void(const TimePosition& at, double end, const complementarity::NewtonRecord&, std::optional<double> error)> newton;
  std::function<void(const TimePosition& at, double end, const complementarity::LinearRecord&, std::optional<double> error)> check;
  /// An attempt was given up: why, and the length of the next one.
  std::function<void(const TimePosition& at, double length, const std::string& why, double next)> retry;
  /// The mesh was refined before the step is begun again.
  std::function<void(const TimePosition& at, GlobalIndex marked, const models::Evolution&)> refined;
  /// After a step, and once before the first step of a run that is not a restart.
  std::function<void(const StepRecord&, const models::Evolution&, const algebra::Vector& X, const complementarity::ActiveSet&)> step;
  /// After `step`, and again before a step is begun anew: whether the run is to end here. A sentence says why; empty: go on.
  std::function<std::string(const TimePosition&, double next_length, const models::Evolution&, const algebra::Vector& X)> stop;
  std::function<void(const std::string&)> message;
};

/// What a run in time has come to.
struct EvolutionOutcome {
  Teuchos::RCP<algebra::Vector> X;  ///< at the last accepted step
  TimePosition at;
  double next_length = 0;                   ///< of the step that would come now
  bool solved = false;                      ///< the end of the time was reached
  bool not_wanted = false;                  ///< max iterations = 0: only counted
  bool refinement_limited = false;          ///< adapt: a limit kept the mesh from becoming as fine as the target wants it
  bool steps_too_long = false;              ///< in a step whose share was too large, most of it was the error in time
  std::string why;                          ///< not solved: one sentence
  std::string stopped;                      ///< ended by EvolutionObserver::stop: its sentence
  std::string mistake;                      ///< in the data of the step that would have come: what an InputError said
  complementarity::ActiveSet active;        ///< of X
  complementarity::NewtonReport last;       ///< of the last attempt
  std::optional<complementarity::Kkt> kkt;  ///< at X
  double kkt_tolerance = 0;
};

/// Backward Euler from time 0, or from a checkpoint, to time/end (TimeParams):
///
///     begin the step; semismooth Newton from a prediction, if the model has one, and from the state before; where it fails, the step is
///     cut in half and begun again; accept.
///
/// The run ends without success where a step would have to be shorter than time/smallest. Where data of a later step are wrong it ends at
/// the last good one (`mistake`); in the first step that is an InputError. With time/adaptive a step whose error in time is
/// too large is begun again, shorter; with a target (stopping/target bounds the error over all time) one whose share is too large,
/// |eta_disc|² > target² length/end, is begun again on a finer mesh, as far as `adapt` allows and unless most of it is the error in time,
/// which only shorter steps take away.
EvolutionOutcome evolve(models::Evolution& evolution, const RunParams& params, const EvolutionObserver& observer,
                        const output::StoredCheckpoint* stored = nullptr);

}  // namespace thixis::drive
