#include "restart/unchanged.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "thixis/core/deck.hpp"
#include "thixis/core/differences.hpp"

namespace thixis::drive {
namespace {

bool begins_with(const std::string& path, const std::string& beginning) { return path.rfind(beginning, 0) == 0; }

/// What the unknowns of the checkpoint are values of. Finer meshes may follow, on other numbers of ranks, and the file may have moved.
bool fixed(const std::string& path) {
  const std::array<const char*, 3> free = {"mesh/refinements", "mesh/cells per rank", "mesh/file"};
  if (std::find(free.begin(), free.end(), path) != free.end()) return false;
  return path == "scene/model" || path == "time/unit" || begins_with(path, "mesh/") || begins_with(path, "method/");
}

/// What only a run from the beginning looks at.
bool of_the_beginning(const models::Catalogue& catalogue, const std::string& path) {
  for (const models::Family& family : catalogue.families())
    for (const std::string& block : family.beginning)
      if (path == block || begins_with(path, block + "/")) return true;
  return false;
}

}  // namespace

void check_unchanged(const output::StoredCheckpoint& stored, const RunParams& params) {
  const auto before = core::Deck::from_text(stored.deck(), stored.path()).parse(params.catalogue->schema());
  std::vector<std::string> mistakes;
  for (const auto& difference : core::differences(params.catalogue->schema(), before, params)) {
    const std::string& path = difference.path;
    if (fixed(path))
      mistakes.push_back(
          fmt::format("{}: the checkpoint '{}' belongs to another model, mesh or method; leave this as it was.", path, stored.path()));
    if (of_the_beginning(*params.catalogue, path))
      mistakes.push_back(fmt::format("{}: a restart begins with the state of the checkpoint; leave this as it was.", path));
  }
  if (!mistakes.empty()) throw core::InputError(fmt::format("{}", fmt::join(mistakes, "\n")));
}

}  // namespace thixis::drive
