#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "thixis/algebra/solver.hpp"
#include "thixis/complementarity/estimate.hpp"
#include "thixis/complementarity/parameters.hpp"
#include "thixis/core/schema.hpp"
#include "thixis/mesh/build.hpp"
#include "thixis/method/params.hpp"

namespace thixis::models {

class Catalogue;

/// Block `scene` of the deck: a catalogued case, or what the model reads besides (`own`).
struct SceneParams {
  std::string model;                     ///< of an Entry
  std::optional<std::string> case_name;  ///< `case` in the deck
  core::Extras own;
};

/// The cell fields of the estimate: eta_disc, eta_lin, eta_alg.
const std::vector<std::string>& names_of_estimate();

/// Block `output` of the deck.
struct OutputParams {
  std::string directory;       ///< empty: results/<name of the deck>
  std::string fields = "all";  ///< all, none, or names separated by commas
  bool history = true;
  int checkpoint_every = 0;    ///< Newton steps, or time steps of scenes in time; 0: only where a run does not converge or is ended
  int fields_every = 10;       ///< time steps
  std::vector<double> probes;  ///< x, y of the first one, of the second one, ... (intervals: x only)
  /// The names in `fields`; nothing for `all`. `none` is asked for by `no_fields`.
  std::vector<std::string> field_names() const;
  /// Those that the driver itself can show, of the estimate (`names_of_estimate`), and those that are left to the model.
  std::vector<std::string> estimate_names() const, model_names() const;
  bool no_fields() const { return fields == "none"; }
};

enum class TimeUnit { none, second, year };
/// Seconds in a unit; a year has 365.25 days. 1 where time has no unit.
double seconds_in(TimeUnit unit);

/// Block `time` of the deck: backward Euler from 0 to the end. All times are in its unit, also t in expressions and rates of data.
struct TimeParams {
  TimeUnit unit = TimeUnit::none;
  double step = 0.01;  ///< length of the steps; of the first one where they are controlled
  double end = 1;
  bool adaptive = false;           ///< the time part of the estimate controls the steps
  std::vector<double> also;        ///< further times at which a step ends
  std::optional<double> smallest;  ///< a step that has been cut below it ends the run; not given: step / 2^20, at least resolution * end
  std::optional<double> largest;   ///< adaptive: no longer step; not given: the end
  double growth = 2;               ///< the next step after a cut or of an adaptive run is at most so many times longer

  /// Of one length. With more of them multiples of the length could not be told from what round-off makes of them.
  static constexpr double most_steps = 1e6;
  /// Of the end: a shorter step hardly moves the time, whose digits end at 1e-16 of it.
  static constexpr double resolution = 1e-13;
  static const core::Schema<TimeParams>& schema();
};

enum class Marking { dorfler, uniform };

/// Block `adapt` of the deck: how the mesh is refined on the way to stopping/target, or as far as its limits allow where there is no
/// target.
struct AdaptParams {
  Marking marking = Marking::dorfler;
  double theta = 0.5;
  int max_levels = 100;              ///< beyond the meshes of the deck
  long long max_unknowns = 1000000;  ///< all fields with the multiplier
  static const core::Schema<AdaptParams>& schema();
};

/// A sublist of `expect/at`: a value that a field must have at a point.
struct ExpectAtParams {
  std::vector<double> place;    ///< x, y; on an interval x
  std::string field;            ///< one of Model::point_fields
  std::vector<double> between;  ///< smallest and largest value
};

/// Block `expect` of the deck: what the run checks of its own result (exit code 4 if it does not hold).
struct ExpectParams {
  std::optional<double> energy_error_at_most;
  std::optional<std::vector<double>> energy_error_between;
  std::optional<int> newton_iterations_at_most, newton_finest_at_most, linear_iterations_at_most;
  std::optional<double> kkt_at_most;
  std::optional<std::vector<double>> effectivity_between;
  std::optional<double> bound_at_most;
  std::optional<complementarity::Promise> promise;
  std::optional<long long> unknowns, cells;
  std::optional<int> steps_at_most, retries_at_most;
  std::optional<std::vector<double>> energy_norm_between, contact_area_between, force_between;
  std::map<std::string, ExpectAtParams> at;
  core::Extras own;  ///< what models have for themselves
};

/// Reports a pair of bounds, if it is given, that is not two numbers in order.
void check_pair(const std::optional<std::vector<double>>& pair, const std::string& name, core::Problems& problems);

/// The whole deck.
struct RunParams {
  SceneParams scene;
  mesh::MeshParams mesh;
  method::MethodParams method;
  complementarity::NewtonParams newton;
  algebra::LinearParams linear;
  complementarity::StoppingParams stopping;
  std::optional<AdaptParams> adapt;
  std::optional<TimeParams> time;
  OutputParams output;
  ExpectParams expect;
  const Catalogue* catalogue = nullptr;  ///< whose names the deck uses

  /// Whether meshes are added to those of the deck: for a target, or because a block `adapt` asks for it.
  bool adaptive() const { return adapt || stopping.target; }
  /// Whether the error is estimated: asked for, or needed by the stopping rule or for adaptivity.
  bool estimated() const;
  bool condensed() const;       ///< unknowns inside the cells are eliminated from the linear systems
  std::string as_deck() const;  ///< XML, with what takes part, which runs again as it is
};

}  // namespace thixis::models
