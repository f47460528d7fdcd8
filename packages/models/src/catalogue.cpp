#include "thixis/models/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "schemas.hpp"
#include "thixis/core/error.hpp"

namespace thixis::models {
namespace {

std::vector<Entry> models_of(const std::vector<Family>& families) {
  std::vector<Entry> all;
  for (const Family& family : families) all.insert(all.end(), family.models.begin(), family.models.end());
  return all;
}

template <class T>
const T& find(const std::vector<T>& all, const std::string& name, const char* path) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const T& one) { return one.name == name; });
  if (found != all.end()) return *found;
  throw core::InputError(fmt::format("{}: there is no '{}'; write {}.", path, name, either(names_of(all, [](const T&) { return true; }))));
}

/// A method and a model that do not go together: what serves what.
std::string not_served(const Catalogue& catalogue, const Entry& model, const method::Method& method) {
  const auto accepted = names_of(catalogue.methods(), [&](const method::Method& one) { return model.accepts(one); });
  if (accepted.size() == 1) return fmt::format("method/name: {} is served by {} alone; write {}.", model.title, accepted[0], accepted[0]);
  std::vector<std::string> served;
  for (const Entry& one : catalogue.models())
    if (one.accepts(method)) served.push_back(one.title);
  return fmt::format("method/name: {} serves {} alone; write {}.", method.name, either(served), either(accepted));
}

}  // namespace

std::string either(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " or ") + names[i];
  return text;
}

void require_right(const SceneParams& params, const Examine& examine) {
  std::string mistakes;
  examine(params, [&](const std::string& path, const std::string& sentence) {
    mistakes += (mistakes.empty() ? "scene" : "\nscene") + (path.empty() ? "" : "/" + path) + ": " + sentence;
  });
  if (!mistakes.empty()) throw core::InputError(mistakes);
}

Catalogue::Catalogue(std::vector<method::Method> methods, std::vector<Family> families)
    : methods_(std::move(methods)),
      families_(std::move(families)),
      models_(models_of(families_)),
      schema_(deck_schema(*this)),
      uses_(uses_of(*this)) {}

const method::Method& Catalogue::method(const std::string& name) const { return find(methods_, name, "method/name"); }
const Entry& Catalogue::model(const std::string& name) const { return find(models_, name, "scene/model"); }

RunParams Catalogue::defaults() const {
  RunParams params;
  params.catalogue = this;
  if (!models_.empty()) params.scene.model = models_.front().name;
  if (!methods_.empty()) params.method.name = methods_.front().name;
  return params;
}

std::unique_ptr<Model> Catalogue::make(const RunParams& params) const {
  const Entry& entry = model(params);
  const method::Method& by = method(params);
  if (!entry.accepts(by)) throw core::InputError(not_served(*this, entry, by));
  return entry.make(params, by);
}

std::optional<RunParams> Catalogue::starting(const std::string& name) const {
  for (const Entry& entry : models_) {
    const bool its_case = std::any_of(entry.cases.begin(), entry.cases.end(), [&](const Case& known) { return known.name == name; });
    if (!its_case && entry.name != name) continue;
    RunParams params;
    params.catalogue = this;
    params.scene.model = entry.name;
    if (its_case) params.scene.case_name = name;
    for (const method::Method& method : methods_)
      if (params.method.name.empty() && entry.accepts(method)) params.method.name = method.name;
    if (entry.in_time) params.time.emplace();
    entry.begin(params);
    return params;
  }
  return std::nullopt;
}

}  // namespace thixis::models
