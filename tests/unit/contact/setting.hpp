#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "thixis/algebra/tpetra.hpp"
#include "thixis/contact/problem.hpp"
#include "thixis/fem/entry.hpp"
#include "thixis/fem/forms.hpp"
#include "thixis/fem/lagrange_space.hpp"
#include "thixis/mesh/build.hpp"
#include "thixis/method/levels.hpp"

namespace thixis::contact {

using algebra::MultiVector;
using algebra::Vector;

/// A square with one edge that is not held, and Lagrange elements on it.
class Square {
 public:
  explicit Square(int degree, int refinements) {
    mesh::MeshParams params;
    params.refinements = refinements;
    params.cells_per_rank = 50;
    levels_ = mesh::build(params, core::Comm(), ".");
    std::vector<bool> held(levels_.finest().tags.size(), true);
    held[1] = false;
    method_.degree = degree;
    method_.condensation = true;
    space_ = fem::make_lagrange_space(levels_.finest(), {held, nullptr, method_});
    method::Levels all(levels_, fem::entry(), [&](const mesh::Mesh&) { return method::SpaceOptions{held, nullptr, method_}; });
    nodes_ = {space_->coordinates(), all.below(static_cast<int>(levels_.levels.size()) - 1)};
  }
  const algebra::Nodes& nodes() const { return nodes_; }
  const method::Space& space() const { return *space_; }
  Vector load(const scene::FieldPtr& force) const {
    const std::vector<scene::FieldPtr> nothing(levels_.finest().tags.size());
    std::vector<scene::FieldPtr> zero(levels_.finest().tags.size(), scene::constant(0));
    Vector F(space_->map());
    method::load(*fem::diffusion(*space_, scene::constant(1)), *force, {nothing, zero}, 0, F);
    return F;
  }

 private:
  method::MethodParams method_;
  mesh::Hierarchy levels_;
  std::unique_ptr<method::Space> space_;
  algebra::Nodes nodes_;
};

inline Small of_rows(const std::vector<std::vector<double>>& rows) {
  Small small;
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < rows[i].size(); ++j) small(static_cast<int>(i), static_cast<int>(j)) = rows[i][j];
  return small;
}
inline Small diagonal(const std::vector<double>& entries) {
  Small small;
  for (std::size_t i = 0; i < entries.size(); ++i) small(static_cast<int>(i), static_cast<int>(i)) = entries[i];
  return small;
}

/// Fields whose operators are those tensions, each a matrix of its own; equal tensions: one matrix.
inline BlockOperator operators(const method::Space& space, const std::vector<scene::FieldPtr>& tensions, bool condensed) {
  BlockOperator S;
  S.fields = static_cast<int>(tensions.size());
  auto cells = std::make_shared<CellForms>(CellForms{space.elements(), space.interior(), true, {}});
  const auto add = [&](const scene::FieldPtr& tension, const Small& weight) {
    S.matrix.push_back(method::assemble(*fem::diffusion(space, tension)));
    S.weight.push_back(weight);
    cells->form.push_back(fem::diffusion(space, tension)->cells());
  };
  std::vector<double> constants;
  for (const auto& tension : tensions)
    if (tension->constant()) constants.push_back(*tension->constant());
  if (constants.size() == tensions.size()) {
    add(scene::constant(1), diagonal(constants));
  } else {
    for (std::size_t i = 0; i < tensions.size(); ++i) {
      std::vector<double> one(tensions.size(), 0);
      one[i] = 1;
      add(tensions[i], diagonal(one));
    }
  }
  if (condensed && space.interior() > 0) S.cells = cells;
  return S;
}

/// A contact point at every `stride`-th node, beginning at the `first`-th.
inline Constraint constraint(const method::Space& space, int gaps, const Frames& frames, int first = 0, int stride = 1) {
  Constraint constraint;
  constraint.gaps = gaps;
  constraint.frames = frames;
  const LocalIndex nodes = algebra::local_size(*space.map()), count = nodes > first ? (nodes - first + stride - 1) / stride : 0;
  const Kokkos::View<LocalIndex*> node("node", count);
  Kokkos::parallel_for(
      "node", Kokkos::RangePolicy<>(0, count), KOKKOS_LAMBDA(int p) { node(p) = first + stride * p; });
  constraint.node = node;
  constraint.points = algebra::contiguous_map(count, algebra::comm_of(*space.map()));
  auto pairing = Teuchos::rcp(new Vector(constraint.points));
  {
    const auto D = algebra::host_overwrite(*pairing), all = algebra::host_view(const_cast<Vector&>(space.pairing()));
    for (LocalIndex p = 0; p < count; ++p) D(p) = all(first + stride * p);
  }
  constraint.pairing = pairing;
  return constraint;
}

inline Teuchos::RCP<MultiVector> zero_load(const method::Space& space, int fields) {
  return Teuchos::rcp(new MultiVector(space.map(), fields));
}

}  // namespace thixis::contact
