#include "thixis/method/levels.hpp"

namespace thixis::method {

Levels::Levels(const mesh::Hierarchy& hierarchy, Method method, std::function<SpaceOptions(const mesh::Mesh&)> options)
    : hierarchy_(hierarchy), method_(std::move(method)), options_(std::move(options)) {}

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

void Levels::keep_to(int level) { levels_.erase(levels_.upper_bound(level), levels_.end()); }

void Levels::keep_from(int level) {
  levels_.erase(levels_.begin(), levels_.lower_bound(level));
  if (const auto first = levels_.find(level); first != levels_.end()) first->second.transfer.reset();
}

}  // namespace thixis::method
