#include <fmt/format.h>

#include <algorithm>

#include "level/membrane_level.hpp"
#include "thixis/core/error.hpp"

namespace thixis::membranes {
namespace {

void check_size(const output::StoredCheckpoint& stored, const std::string& block, GlobalIndex unknowns) {
  const GlobalIndex saved = stored.size(block);
  if (saved == unknowns) return;
  throw core::InputError(
      fmt::format("The checkpoint '{}' belongs to another model, mesh or method: it holds {}, the deck asks for {}; leave scene/model, "
                  "mesh, method and the kinds of the boundary as they were.",
                  stored.path(), saved < 0 ? fmt::format("no '{}'", block) : fmt::format("{} values of '{}'", saved, block), unknowns));
}

}  // namespace

using algebra::Vector;

std::vector<output::CheckpointBlock> MembraneLevel::save(const Vector& X, const std::string& suffix) const {
  const Fields x = fields(X);
  std::vector<output::CheckpointBlock> blocks;
  const auto ids = space_->unknown_ids();
  const auto add = [&](const std::string& name, const Vector& v) {
    const auto values = algebra::host_view(v);
    const auto count = static_cast<std::ptrdiff_t>(values.extent(0));
    blocks.push_back({name + suffix, {ids.begin(), ids.begin() + count}, {values.data(), values.data() + count}});
  };
  for (int alpha = 0; alpha < scene_.count; ++alpha) add(displacement(scene_.count, alpha), *x.u.getVector(alpha));
  add("lambda", x.lambda);
  if (origin_ != 0) {
    const bool root = space_->mesh().comm.root();
    blocks.push_back({"origin" + suffix, root ? std::vector<GlobalIndex>{0} : std::vector<GlobalIndex>{},
                      root ? std::vector<double>{origin_} : std::vector<double>{}});
  }
  return blocks;
}

Teuchos::RCP<Vector> MembraneLevel::restore(const output::StoredCheckpoint& stored, const std::string& suffix) const {
  const auto X = zero();
  Fields x = fields(*X);
  const auto ids = space_->unknown_ids();
  const auto fetch = [&](const std::string& name, Vector& v) {
    check_size(stored, name + suffix, static_cast<GlobalIndex>(v.getGlobalLength()));
    const auto values = stored.fetch_finite(name + suffix, {ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(v.getLocalLength())});
    const auto out = algebra::host_overwrite(v);
    std::copy(values.begin(), values.end(), out.data());
  };
  for (int alpha = 0; alpha < scene_.count; ++alpha) fetch(displacement(scene_.count, alpha), *x.u.getVectorNonConst(alpha));
  fetch("lambda", x.lambda);
  const double origin = stored.size("origin" + suffix) < 0 ? 0 : stored.fetch_finite("origin" + suffix, {0}).front();
  if (origin != origin_) {
    Vector by(space_->map());
    space_->interpolate(*scene::constant(origin - origin_), 0, by);
    for (int alpha = 0; alpha < scene_.count; ++alpha) x.u.getVectorNonConst(alpha)->update(1, by, 1);
  }
  return X;
}

}  // namespace thixis::membranes
