#include "thixis/method/levels.hpp"

#include "thixis/algebra/tpetra.hpp"
#include "transfer/hats.hpp"

namespace thixis::method {

Levels::Levels(const mesh::Hierarchy& hierarchy, Method method, std::function<SpaceOptions(const mesh::Mesh&)> options)
    : hierarchy_(hierarchy), method_(std::move(method)), options_(std::move(options)) {}

Levels::~Levels() = default;

std::shared_ptr<Space> Levels::space(int level) {
  auto& space = levels_[level].space;
  if (!space) {
    const mesh::Mesh& mesh = hierarchy_.levels.at(level);
    space = method_.make_space(mesh, options_(mesh));
  }
  return space;
}

FormPtr Levels::diffusion(int level, const scene::FieldPtr& tension) {
  const auto on = space(level);
  FormPtr& form = levels_[level].diffusion[tension];
  if (!form) form = method_.diffusion(*on, tension);
  return form;
}

const Transfer& Levels::transfer(int level) {
  const auto coarse = space(level - 1), fine = space(level);
  auto& transfer = levels_[level].transfer;
  if (!transfer) transfer = std::make_unique<Transfer>(*coarse, *fine);
  return *transfer;
}

const Hats& Levels::hats(int level) {
  auto& hats = hats_[level].hats;
  if (!hats) {
    const mesh::Mesh& mesh = hierarchy_.levels.at(level);
    hats = std::make_unique<Hats>(mesh, options_(mesh).dirichlet);
  }
  return *hats;
}

const Teuchos::RCP<const algebra::Matrix>& Levels::hats_in_finer(int level) {
  auto& P = hats_[level].in_finer;
  if (P.is_null()) P = in_finer(hats(level - 1), hats(level));
  return P;
}

std::vector<Teuchos::RCP<const algebra::Matrix>> Levels::below(int level) {
  const auto on = space(level);
  const bool hats_alone = on->conforming() && on->basis().degree() == 1;
  const auto empty = [&](int of) { return hats(of).map()->getGlobalNumElements() == 0; };
  std::vector<Teuchos::RCP<const algebra::Matrix>> below;
  if (!hats_alone && !empty(level)) below.push_back(in_finer(hats(level), *on));
  for (int next = level; next > 0 && !empty(next - 1); --next) below.push_back(hats_in_finer(next));
  return below;
}

void Levels::keep_to(int level) {
  levels_.erase(levels_.upper_bound(level), levels_.end());
  hats_.erase(hats_.upper_bound(level), hats_.end());
}

void Levels::keep_from(int level) {
  levels_.erase(levels_.begin(), levels_.lower_bound(level));
  if (const auto first = levels_.find(level); first != levels_.end()) first->second.transfer.reset();
}

}  // namespace thixis::method
