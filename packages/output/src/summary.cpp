#include "thixis/output/summary.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "files/text_file.hpp"
#include "thixis/core/error.hpp"

namespace thixis::output {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

Json object(const std::vector<std::pair<std::string, double>>& entries) {
  Json result = Json::object();
  for (const auto& [key, value] : entries) result[key] = number(value);
  return result;
}

void append(Json& object, const Json& entries) {
  for (const auto& [key, value] : entries.items()) {
    if (object.contains(key)) throw core::Error(core::ExitCode::internal, fmt::format("The summary has a key '{}' already.", key));
    object[key] = value;
  }
}

Json json(const std::optional<SummaryEstimate>& estimate) {
  if (!estimate) return nullptr;
  Json result = object({{"total", estimate->total},
                        {"discretization", estimate->discretization},
                        {"linearization", estimate->linearization},
                        {"algebraic", estimate->algebraic}});
  result["promise"] = estimate->promise;
  if (!estimate->doubts.empty()) result["doubts"] = estimate->doubts;
  append(result, object(estimate->terms));
  if (estimate->time) append(result, object({{"time", *estimate->time}}));
  return result;
}

Json json(const std::vector<SummaryEntry>& entries) {
  Json result = Json::object();
  for (const auto& entry : entries) result[entry.key] = entry.parts.empty() ? number(entry.value) : object(entry.parts);
  return result;
}

Json json(const Summary& s) {
  Json result;
  result["verdict"] = s.verdict;
  result["exit_code"] = s.exit_code;
  result["model"] = s.model;
  result["case"] = s.problem_case;
  result["method"] = s.method;
  result["degree"] = s.degree;
  result["ranks"] = s.ranks;
  result["threads"] = s.threads;
  result["cells"] = s.cells;
  result["unknowns"] = {{"all", s.unknowns.all}, {"global", s.unknowns.global}};
  result["nonzeros"] = s.nonzeros;
  result["newton_iterations"] = s.newton_iterations;
  result["newton_finest"] = s.newton_finest;
  result["linear_iterations"] = s.linear_iterations;
  if (s.in_time) {
    result["steps"] = s.in_time->steps;
    result["retries"] = s.in_time->retries;
    result["time_end"] = number(s.in_time->end);
  }
  result["energy_error"] = number(s.energy_error);
  result["energy_norm"] = number(s.energy_norm);
  result["estimate"] = json(s.estimate);
  result["estimate_published"] = json(s.estimate_published);
  result["effectivity"] = number(s.effectivity);
  result["effectivity_published"] = number(s.effectivity_published);
  result["kkt"] = {{"infeasible", number(s.kkt.infeasible)},
                   {"negative", number(s.kkt.negative)},
                   {"complementary", number(s.kkt.complementary)},
                   {"between_nodes", number(s.kkt.between_nodes)},
                   {"equilibrium", number(s.kkt.equilibrium)}};
  result["active_points"] = s.active_points ? Json(*s.active_points) : Json(nullptr);
  result["time"] = object({{"total", s.time.total},
                           {"mesh", s.time.mesh},
                           {"assembly", s.time.assembly},
                           {"preconditioner", s.time.preconditioner},
                           {"linear", s.time.linear},
                           {"estimate", s.time.estimate},
                           {"output", s.time.output}});
  result["memory_mb"] = number(s.memory_mb);
  result["versions"] = Json::object();
  for (const auto& [name, version] : s.versions) result["versions"][name] = version;
  append(result, json(s.of_model));
  return result;
}

}  // namespace

std::string Summary::text() const {
  // Texts from outside (paths in a verdict) need not be UTF-8; the summary is written all the same.
  return json(*this).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void Summary::write(const std::string& path, const core::Comm& comm) const {
  if (!comm.on_root([&] { return enabled; })) return;
  comm.on_root([&] { write_text(path, text()); });
}

}  // namespace thixis::output
