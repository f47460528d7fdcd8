#include "restart/checkpoint.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "refine/marking.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/differences.hpp"
#include "thixis/core/log.hpp"
#include "thixis/core/text.hpp"
#include "thixis/core/timer.hpp"
#include "thixis/mesh/adapt.hpp"

namespace thixis::drive {
namespace {

namespace fs = std::filesystem;

std::string absolute(const std::string& path) { return fs::absolute(path).lexically_normal().string(); }

constexpr GlobalIndex most_rows = 1ll << 50;

/// The block with the cells whose refinement made `level`.
std::string marks_of(int level) { return fmt::format("marked for level {}", level); }

/// The deck as run, from whatever folder.
output::Checkpoint frame_of(const RunParams& params, const core::Deck& deck) {
  RunParams as_run = params;
  as_run.output.directory = absolute(params.output.directory);
  output::Checkpoint frame;
  frame.deck = as_run.as_deck();
  frame.folder = absolute(deck.folder());
  return frame;
}

}  // namespace

void remove_file(const std::string& path, const core::Comm& comm) {
  comm.on_root([&] {
    std::error_code absent;
    fs::remove(path, absent);
  });
}

CheckpointFile::CheckpointFile(std::string path, const RunParams& params, const core::Deck& deck)
    : path_(std::move(path)), frame_(frame_of(params, deck)) {}

bool CheckpointFile::write(const models::SceneOnMesh& scene, const algebra::Vector& X, int level,
                           std::map<std::string, double> of_run) const {
  if (!std::isfinite(algebra::norm2(X))) return false;
  const core::Comm& comm = scene.comm();
  models::State state = scene.save(X);
  output::Checkpoint checkpoint = frame_;
  checkpoint.level = level;
  checkpoint.attributes = std::move(of_run);
  checkpoint.attributes["seconds"] = comm.max(checkpoint.attributes["seconds"]);
  checkpoint.attributes.merge(state.attributes);
  checkpoint.blocks = std::move(state.blocks);
  for (const auto& [made, marked] : marked_)
    if (made <= level) checkpoint.blocks.push_back(output::list_block(marks_of(made), marked, comm.root()));
  output::write_checkpoint(path_, checkpoint, comm);
  return true;
}

void replay(const output::StoredCheckpoint& stored, mesh::Hierarchy& hierarchy, CheckpointFile& checkpoint) {
  const core::Region region("mesh");
  for (auto level = static_cast<int>(hierarchy.levels.size()); level <= stored.level(); ++level) {
    if (stored.size(marks_of(level)) < 0) return;  // check_restart has the sentence
    const std::vector<GlobalIndex> marked = stored.fetch_list(marks_of(level));
    mesh::adapt(hierarchy, owned(hierarchy.finest(), marked));
    checkpoint.refined(level, marked);
  }
}

void say_differences(const output::StoredCheckpoint& stored, const RunParams& params) {
  RunParams before = core::Deck::from_text(stored.deck(), stored.path()).parse(params.catalogue->schema());
  before.output.directory = params.output.directory;
  std::vector<std::string> of_problem, others;
  for (const auto& difference : core::differences(params.catalogue->schema(), before, params)) {
    const bool another = difference.path.rfind("scene/", 0) == 0 || difference.path == "mesh/file";
    (another ? of_problem : others).push_back(difference.sentence());
  }
  if (!of_problem.empty())
    core::log::warn("this is another problem than that of the checkpoint, whose state is where it begins: {}", core::join(of_problem));
  if (!others.empty()) core::log::info("other parameters than those of the checkpoint: {}", core::join(others));
}

bool same_directory(const output::StoredCheckpoint& stored, const RunParams& params, const std::string& directory) {
  const auto before = core::Deck::from_text(stored.deck(), stored.path()).parse(params.catalogue->schema()).output.directory;
  const std::string now = absolute(directory + "/");
  return now == absolute(before + "/") || now == absolute(fs::absolute(stored.path()).parent_path().string() + "/");
}

void check_restart(const output::StoredCheckpoint& stored, const RunParams& params, const mesh::Hierarchy& hierarchy) {
  const auto levels = static_cast<int>(hierarchy.levels.size());
  const int level = stored.level();
  if (level < 0 || level >= levels)
    throw core::InputError(
        fmt::format("mesh/refinements: the checkpoint '{}' belongs to level {} and the deck has the levels 0 to {}; "
                    "leave mesh as it was, or refine more.",
                    stored.path(), level, levels - 1));
  const auto cells = stored.count("cells", most_rows);
  if (hierarchy.levels[level].global_cells != cells)
    throw core::InputError(fmt::format(
        "mesh: the checkpoint '{}' belongs to another mesh: its level {} has {} cells, that of the deck {}; leave mesh as it was.",
        stored.path(), level, cells, hierarchy.levels[level].global_cells));
  if (level + 1 < levels && params.newton.start == complementarity::Start::cold)
    throw core::InputError(fmt::format(
        "newton/start: the checkpoint '{}' belongs to level {} of 0 to {}; write newton/start = nested to go on to the finer ones, "
        "or leave mesh/refinements as it was.",
        stored.path(), level, levels - 1));
}

}  // namespace thixis::drive
