#pragma once
#include <gtest/gtest.h>

#include <cmath>

#include "thixis/algebra/tpetra.hpp"
#include "thixis/mesh/adapt.hpp"
#include "thixis/mesh/build.hpp"
#include "thixis/method/levels.hpp"

/// What every Transfer must be, whatever the method.
namespace thixis::method {

/// Two uniform refinements and two adaptive ones, after which cells lie on other ranks than their parents.
inline mesh::Hierarchy mixed_levels() {
  mesh::MeshParams params;
  params.cells_per_side = 2;
  params.refinements = 2;
  params.cells_per_rank = 10;
  auto levels = mesh::build(params, core::Comm(), ".");
  for (int round = 0; round < 2; ++round) {
    std::vector<LocalIndex> marked;
    const mesh::Mesh& mesh = levels.finest();
    for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
      if (mesh.cell_id[K] % 5 < 2 - round) marked.push_back(K);
    mesh::adapt(levels, marked);
  }
  return levels;
}

/// Numbers in [-1, 1] that depend on the unknown and not on the ranks.
inline algebra::Vector some_numbers(const Space& space, int seed) {
  algebra::Vector v(space.map());
  const auto ids = space.unknown_ids();
  const auto values = algebra::host_overwrite(v);
  for (std::size_t row = 0; row < ids.size(); ++row) values(row) = std::sin(78.233 * static_cast<double>(ids[row] % 100003) + seed);
  return v;
}

/// (P x, y) = (x, Pᵀ y), P x is what prolongation of the function without boundary values gives, and P is not 0.
inline void expect_adjoint(const Method& method, SpaceOptions options, bool held) {
  const auto levels = mixed_levels();
  options.dirichlet.assign(options.components * levels.finest().tags.size(), held);
  for (std::size_t j = 1; j < levels.levels.size(); ++j) {
    const auto coarse = method.make_space(levels.levels[j - 1], options), fine = method.make_space(levels.levels[j], options);
    const Transfer P(*coarse, *fine);
    const auto x = some_numbers(*coarse, 1), y = some_numbers(*fine, 2);
    algebra::Vector Px(fine->map()), Pty(coarse->map()), prolonged(fine->map());
    P.apply(x, Px);
    P.apply_transpose(y, Pty);
    const double size = Px.norm2() * y.norm2();
    EXPECT_GT(Px.norm2(), 0.5 * x.norm2()) << method.name << ", level " << j;
    EXPECT_NEAR(Px.dot(y), x.dot(Pty), 1e-13 * size) << method.name << ", level " << j;
    EXPECT_GT(std::abs(x.dot(Pty)), 1e-8 * size);
    P.prolongate(coarse->complete(x, Coefficients("zero", coarse->coefficients().entries.size())), prolonged);
    prolonged.update(-1, Px, 1);
    EXPECT_LE(prolonged.normInf(), 1e-14);
  }
}

/// What a function with components is on the coarse mesh, it is on the fine one.
inline void expect_components(const Method& method, SpaceOptions options) {
  const auto levels = mixed_levels();
  const int p = options.params.degree;
  options.components = 2;
  options.dirichlet.assign(2 * levels.finest().tags.size(), false);
  const std::vector<scene::FieldPtr> u = {scene::formula([p](double x, double y) { return std::pow(0.4 + x - 0.5 * y, p); }),
                                          scene::formula([p](double x, double y) { return std::pow(y - 2 * x, p) - 3; })};
  for (std::size_t j = 1; j < levels.levels.size(); ++j) {
    const auto coarse = method.make_space(levels.levels[j - 1], options), fine = method.make_space(levels.levels[j], options);
    algebra::Vector of_coarse(coarse->map()), of_fine(fine->map()), exact(fine->map());
    coarse->interpolate(u, 0, of_coarse);
    fine->interpolate(u, 0, exact);
    Transfer(*coarse, *fine).apply(of_coarse, of_fine);
    of_fine.update(-1, exact, 1);
    EXPECT_LE(of_fine.normInf(), 1e-11) << method.name << p << ", level " << j;
  }
}

/// min |P_1 P_2 … P_j v - y| over v by conjugate gradients on the normal equations, so that it tests Pᵀ, too.
inline double distance_from_range(const std::vector<Teuchos::RCP<const algebra::Matrix>>& P, const algebra::Vector& y) {
  const auto up = [&](const algebra::Vector& v) {
    auto fine = std::make_unique<algebra::Vector>(v, Teuchos::Copy);
    for (auto p = P.rbegin(); p != P.rend(); ++p) {
      auto next = std::make_unique<algebra::Vector>((*p)->getRangeMap());
      (*p)->apply(*fine, *next);
      fine = std::move(next);
    }
    return fine;
  };
  const auto down = [&](const algebra::Vector& r) {
    auto coarse = std::make_unique<algebra::Vector>(r, Teuchos::Copy);
    for (const auto& p : P) {
      auto next = std::make_unique<algebra::Vector>(p->getDomainMap());
      p->apply(*coarse, *next, Teuchos::TRANS);
      coarse = std::move(next);
    }
    return coarse;
  };
  algebra::Vector r(y, Teuchos::Copy);
  auto s = down(r);
  algebra::Vector p(*s, Teuchos::Copy);
  double rho = s->dot(*s);
  for (int i = 0; i < 60 && rho > 1e-28; ++i) {
    const auto q = up(p);
    r.update(-rho / q->dot(*q), *q, 1);
    s = down(r);
    const double next = s->dot(*s);
    p.update(1, *s, next / rho);
    rho = next;
  }
  return r.normInf();
}

/// The hats of the coarsest mesh hold the linear functions, in whatever space they end, and not what bends in its cells.
inline void expect_hats(const Method& method, SpaceOptions options) {
  const auto hierarchy = mixed_levels();
  options.dirichlet.assign(hierarchy.finest().tags.size(), false);
  Levels levels(hierarchy, method, [&](const mesh::Mesh&) { return options; });
  const auto linear = scene::formula([](double x, double y) { return 2 + x - 3 * y; });
  const auto bent = scene::formula([](double x, double y) { return x * y; });
  for (int j = 0; j < static_cast<int>(hierarchy.levels.size()); ++j) {
    const auto space = levels.space(j);
    const auto below = levels.below(j);
    const bool hats_alone = space->conforming() && options.params.degree == 1;
    ASSERT_EQ(below.size(), j + (hats_alone ? 0 : 1)) << method.name;
    if (below.empty()) continue;
    EXPECT_TRUE(below.front()->getRangeMap()->isSameAs(*space->map()));
    algebra::Vector y(space->map()), z(space->map());
    space->interpolate(*linear, 0, y);
    space->interpolate(*bent, 0, z);
    EXPECT_LE(distance_from_range(below, y), 1e-10) << method.name << options.params.degree << ", level " << j;
    if (j == 0 && options.params.degree == 1) continue;  // the interpolant of anything is linear in every cell there
    EXPECT_GE(distance_from_range(below, z), 1e-3) << method.name << options.params.degree << ", level " << j;
  }
}

/// A polynomial goes up all levels; what is there once is there for all who ask, until it is forgotten.
inline void expect_kept(const Method& method, SpaceOptions options) {
  const auto hierarchy = mixed_levels();
  options.dirichlet.assign(hierarchy.finest().tags.size(), false);
  Levels levels(hierarchy, method, [&](const mesh::Mesh&) { return options; });
  const auto u = scene::formula([](double x, double y) { return 2 + x - 3 * y; });
  const int finest = static_cast<int>(hierarchy.levels.size()) - 1;
  auto values = std::make_unique<algebra::Vector>(levels.space(0)->map());
  levels.space(0)->interpolate(*u, 0, *values);
  for (int j = 1; j <= finest; ++j) {
    auto finer = std::make_unique<algebra::Vector>(levels.space(j)->map());
    levels.transfer(j).apply(*values, *finer);
    values = std::move(finer);
  }
  algebra::Vector exact(levels.space(finest)->map());
  levels.space(finest)->interpolate(*u, 0, exact);
  exact.update(-1, *values, 1);
  EXPECT_LE(exact.normInf(), 1e-12) << method.name;

  const auto tension = scene::constant(2);
  EXPECT_EQ(levels.kept(), finest + 1);
  EXPECT_EQ(&levels.transfer(1), &levels.transfer(1));
  EXPECT_EQ(levels.diffusion(finest, tension), levels.diffusion(finest, tension));
  EXPECT_NE(levels.diffusion(finest, tension), levels.diffusion(finest, scene::constant(2)));
  EXPECT_EQ(&levels.diffusion(finest, tension)->space(), levels.space(finest).get());
  const std::weak_ptr<Space> coarse = levels.space(finest - 1), fine = levels.space(finest);
  levels.keep_to(finest);
  EXPECT_EQ(levels.kept(), finest + 1);
  levels.keep_from(finest);
  EXPECT_EQ(levels.kept(), 1);
  EXPECT_TRUE(coarse.expired());
  EXPECT_FALSE(fine.expired());
  levels.keep_to(finest - 1);
  EXPECT_EQ(levels.kept(), 0);
  EXPECT_TRUE(fine.expired());
  EXPECT_EQ(&levels.space(0)->mesh(), &hierarchy.levels.front());
}

}  // namespace thixis::method
