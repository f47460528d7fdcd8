#include "thixis/method/quadrature.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "thixis/core/error.hpp"
#include "thixis/mesh/build.hpp"

namespace thixis::method {
namespace {

using scene::FieldPtr;

mesh::Mesh square(int level) {
  mesh::MeshParams params;
  params.refinements = level;
  return mesh::build(params, core::Comm(), ".").levels.back();
}
mesh::Mesh disk(int rings) {
  mesh::MeshParams params;
  params.generator = mesh::Generator::disk;
  params.rings = rings;
  return mesh::build(params, core::Comm(), ".").levels.back();
}

struct Circle {
  double x, y, R;
  double level(double px, double py) const { return std::hypot(px - x, py - y) - R; }
  FieldPtr level_set() const {
    return scene::formula([c = *this](double px, double py) { return c.level(px, py); });
  }
  /// ((x - x0)/R)^a ((y - y0)/R)^b inside, 0 outside.
  FieldPtr monomial(int a, int b) const {
    return scene::formula([c = *this, a, b](double px, double py) {
      return c.level(px, py) < 0 ? std::pow((px - c.x) / c.R, a) * std::pow((py - c.y) / c.R, b) : 0.0;
    });
  }
  /// Integral of monomial(a, b) for even a, b: 2 R^2 Gamma((a+1)/2) Gamma((b+1)/2) / ((a+b+2) Gamma((a+b+2)/2)).
  double moment(int a, int b) const {
    return 2 * R * R * std::tgamma((a + 1) / 2.0) * std::tgamma((b + 1) / 2.0) / ((a + b + 2) * std::tgamma((a + b + 2) / 2.0));
  }
};

/// The integral over the whole mesh; also checks the block's own promises.
double integrate(const mesh::Mesh& mesh, const CellQuadrature& quadrature, const FieldPtr& field) {
  View<double*> value("value", quadrature.largest_block);
  double sum = 0;
  for_each_block(quadrature, [&](const QuadratureBlock& block) {
    evaluate(*field, 0, block, value);
    EXPECT_EQ(block.offset(0), 0);
    EXPECT_EQ(block.offset(block.cells), block.points);
    for (int q = 0; q < block.points; ++q) sum += block.weight(q) * value(q);
  });
  return mesh.comm.sum(sum);
}
double integrate(const mesh::Mesh& mesh, const FieldPtr& level_set, int order, const FieldPtr& field) {
  return integrate(mesh, make_quadrature(mesh, owned_cells(mesh), order, level_set), field);
}

void expect_moments(const mesh::Mesh& mesh, const Circle& circle, const FieldPtr& level_set, int order, double tolerance,
                    const std::string& where) {
  const CellQuadrature quadrature = make_quadrature(mesh, owned_cells(mesh), order, level_set);
  for (const auto& [a, b] : {std::pair{0, 0}, {2, 0}, {0, 2}})
    EXPECT_NEAR(integrate(mesh, quadrature, circle.monomial(a, b)) / circle.moment(a, b), 1, tolerance)
        << where << ", order " << order << ", moment " << a << b;
}

TEST(CellQuadrature, integrates_polynomials_of_its_order_on_the_square) {
  const mesh::Mesh mesh = square(1);
  for (const int order : {0, 1, 4, 7, 12})
    for (int a = 0; a <= order; ++a) {
      const int b = order - a;
      const FieldPtr monomial = scene::formula([=](double x, double y) { return std::pow(x, a) * std::pow(y, b); });
      EXPECT_NEAR(integrate(mesh, nullptr, order, monomial) * (a + 1) * (b + 1), 1, 1e-13) << "x^" << a << " y^" << b;
    }
}

TEST(CutCells, give_the_moments_of_a_disk_on_the_criss_cross_square) {
  const Circle circle{0.5, 0.5, 1.0 / 3};
  for (int level = 0; level <= 3; ++level)
    for (const int order : {2, 4, 8, 12})
      expect_moments(square(level), circle, circle.level_set(), order, 1e-10, "T_" + std::to_string(level));
}

TEST(CutCells, give_the_moments_of_a_disk_on_ring_meshes) {
  const Circle circle{0, 0, std::sqrt(0.5)};
  for (const int rings : {2, 4, 8, 16})
    for (const int order : {2, 4, 8})
      expect_moments(disk(rings), circle, circle.level_set(), order, 1e-10, std::to_string(rings) + " rings");
}

TEST(CutCells, keep_polynomials_of_their_order_exact_on_both_sides) {
  const Circle circle{0.5, 0.5, 1.0 / 3};
  const mesh::Mesh mesh = square(0);
  for (const int order : {2, 4, 8}) {
    const CellQuadrature quadrature = make_quadrature(mesh, owned_cells(mesh), order, circle.level_set());
    for (int a = 0; a <= order; ++a) {
      const int b = order - a;
      const FieldPtr monomial = scene::formula([=](double x, double y) { return std::pow(x, a) * std::pow(y, b); });
      EXPECT_NEAR(integrate(mesh, quadrature, monomial) * (a + 1) * (b + 1), 1, 1e-11) << "order " << order << ", x^" << a << " y^" << b;
    }
  }
}

TEST(CutCells, give_high_moments_of_a_disk_at_high_order) {
  const Circle circle{0.5, 0.5, 1.0 / 3};
  for (int level = 0; level <= 2; ++level) {
    const mesh::Mesh mesh = square(level);
    const CellQuadrature quadrature = make_quadrature(mesh, owned_cells(mesh), 8, circle.level_set());
    for (const auto& [a, b] : {std::pair{4, 4}, {8, 0}, {2, 6}})
      EXPECT_NEAR(integrate(mesh, quadrature, circle.monomial(a, b)) / circle.moment(a, b), 1, 1e-10)
          << "T_" << level << ", moment " << a << b;
  }
}

TEST(CutCells, follow_a_curve_through_vertices) {
  const double R = 0.25;  // centre at a vertex: through the vertices (3/4, 1/2), …
  for (int level = 0; level <= 2; ++level) {
    expect_moments(square(level), {0.5, 0.5, R}, Circle{0.5, 0.5, R}.level_set(), 4, 1e-10, "vertex");
    const Circle shifted{0.5, 0.5, R + 1e-14};
    expect_moments(square(level), shifted, shifted.level_set(), 4, 1e-10, "almost a vertex");
    const Circle near{0.5, 0.5, R - 1e-7};
    expect_moments(square(level), near, near.level_set(), 4, 1e-10, "near a vertex");
  }
}

TEST(CutCells, follow_a_curve_that_touches_or_just_crosses_an_edge) {
  for (const double beyond : {0.0, 1e-13, -1e-13, 1e-8, -1e-8, 1e-5, -1e-5, 1e-3, -1e-3, 1e-2})
    for (const double y : {0.5, 0.47, 0.375}) {
      const Circle circle{0.5, y, 0.25 + beyond};  // near to the lines x = 1/4 and x = 3/4
      for (int level = 0; level <= 2; ++level)
        expect_moments(square(level), circle, circle.level_set(), 4, 1e-10,
                       "beyond by " + std::to_string(beyond) + " on T_" + std::to_string(level));
    }
}

TEST(CutCells, follow_several_circles_given_by_a_product) {
  const Circle a{0.3, 0.3, 0.17}, b{0.7, 0.65, 0.21};
  const FieldPtr product = scene::formula([=](double x, double y) { return a.level(x, y) * b.level(x, y); });
  for (int level = 0; level <= 3; ++level) {
    expect_moments(square(level), a, product, 4, 1e-10, "first circle on T_" + std::to_string(level));
    expect_moments(square(level), b, product, 4, 1e-10, "second circle on T_" + std::to_string(level));
  }
}

TEST(CutCells, follow_any_circle) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int k = 0; k < 200; ++k) {
    const double R = 0.07 + 0.38 * unit(random);
    const Circle circle{R + (1 - 2 * R) * unit(random), R + (1 - 2 * R) * unit(random), R};
    expect_moments(square(k % 3), circle, circle.level_set(), 4, 1e-10,
                   "centre " + std::to_string(circle.x) + " " + std::to_string(circle.y) + ", R " + std::to_string(R));
  }
  // Three that look into a cell through a corner of it.
  for (const Circle& circle : {Circle{0.4666073847736255, 0.818873842702516, 0.1628030362871558},
                               Circle{0.2703765398068436, 0.6857585334105885, 0.07058737951353697},
                               Circle{0.2701864039151451, 0.5823093948563827, 0.08507659286376382}})
    expect_moments(square(0), circle, circle.level_set(), 4, 1e-10, "corner");
}

TEST(CutCells, follow_nested_rings) {
  const mesh::Mesh mesh = disk(10);  // some of the circles pass through the vertices of the mesh
  const FieldPtr product = scene::formula([](double x, double y) {
    const double r = std::hypot(x, y);
    return (r - 0.2) * (r - 0.4) * (r - 0.6) * (r - 0.8);
  });
  for (const double R : {0.2, 0.4, 0.6, 0.8}) expect_moments(mesh, {0, 0, R}, product, 4, 1e-10, "R = " + std::to_string(R));
}

TEST(CutCells, do_not_depend_on_the_form_of_the_level_set) {
  const Circle circle{0.5, 0.5, 1.0 / 3};
  const mesh::Mesh mesh = square(1);
  expect_moments(mesh, circle, scene::formula([=](double x, double y) { return -1e-6 * circle.level(x, y); }), 4, 1e-10, "small");
  expect_moments(mesh, circle, scene::formula([=](double x, double y) { return std::exp(3 * circle.level(x, y)) - 1; }), 4, 1e-10, "steep");
  expect_moments(mesh, circle, scene::formula([=](double x, double y) { return std::pow(circle.level(x, y), 3); }), 4, 1e-8, "flat");
  expect_moments(mesh, circle, scene::formula([=](double x, double y) { return circle.level(x, y) < 0 ? -1.0 : 1.0; }), 4, 1e-8, "steps");
}

TEST(CutCells, are_no_cells_that_only_touch_the_curve) {
  const mesh::Mesh mesh = square(1);
  const auto cut = [&](const FieldPtr& level_set) {
    return mesh.comm.sum(make_quadrature(mesh, owned_cells(mesh), 4, level_set).cut_cells());
  };
  EXPECT_EQ(cut(scene::formula([](double x, double) { return x - 0.5; })), 0) << "a line along edges";
  EXPECT_EQ(cut(scene::formula([](double x, double y) { return 3 * (x - y); })), 0) << "a line along edges";
  EXPECT_EQ(cut(scene::formula([](double, double) { return 1.0; })), 0);
  EXPECT_EQ(cut(scene::constant(0)), 0);
  EXPECT_EQ(cut(nullptr), 0);
  EXPECT_GT(cut(scene::formula([](double x, double) { return x - 0.51; })), 0);
}

TEST(CutCells, have_positive_weights_that_sum_to_the_area_and_points_inside_and_off_the_curve) {
  const Circle circle{0.5, 0.47, 0.25};
  for (int level = 0; level <= 2; ++level) {
    const mesh::Mesh mesh = square(level);
    const CellQuadrature quadrature = make_quadrature(mesh, owned_cells(mesh), 4, circle.level_set());
    EXPECT_GT(mesh.comm.sum(quadrature.cut_cells()), 0);
    for (LocalIndex c = 0; c < quadrature.cut_cells(); ++c) {
      double sum = 0;
      for (GlobalIndex q = quadrature.own_offset(c); q < quadrature.own_offset(c + 1); ++q) {
        EXPECT_GT(quadrature.own_weight(q), 0);
        const double xi = quadrature.own_xi(q, 0), eta = quadrature.own_xi(q, 1);
        EXPECT_TRUE(xi > 0 && eta > 0 && xi + eta < 1);
        sum += quadrature.own_weight(q);
      }
      EXPECT_NEAR(sum, 0.5, 1e-12);
    }
    for_each_block(quadrature, [&](const QuadratureBlock& block) {
      for (int q = 0; q < block.points; ++q) EXPECT_NE(circle.level(block.x(q), block.y(q)), 0);
    });
  }
}

TEST(CutCells, cost_a_bounded_number_of_points) {
  const Circle circle{0.5, 0.5, 1.0 / 3};
  for (const int order : {2, 4, 8}) {
    for (int level = 0; level <= 4; ++level) {
      const mesh::Mesh mesh = square(level);
      const CellQuadrature quadrature = make_quadrature(mesh, owned_cells(mesh), order, circle.level_set());
      const int cells = mesh.comm.sum(quadrature.cut_cells());
      const double each = static_cast<double>(mesh.comm.sum(static_cast<long long>(quadrature.own_weight.extent(0)))) / cells;
      EXPECT_GT(cells, 8 << level);
      EXPECT_LT(cells, 64 << level);
      EXPECT_LT(each, 4.0 * (order + 6) * (order + 6) / 2) << "points per cut cell, order " << order << ", T_" << level;
      RecordProperty("points per cut cell, order " + std::to_string(order) + ", level " + std::to_string(level), std::to_string(each));
    }
  }
}

TEST(QuadratureBlocks, give_the_same_integral_whatever_their_size) {
  const Circle circle{0.5, 0.5, 1.0 / 3};
  const mesh::Mesh mesh = square(1);
  const double whole = integrate(mesh, make_quadrature(mesh, owned_cells(mesh), 4, circle.level_set()), circle.monomial(2, 0));
  for (const int cells : {1, 7, 100}) {
    const CellQuadrature quadrature = make_quadrature(mesh, owned_cells(mesh), 4, circle.level_set(), 0, cells);
    EXPECT_NEAR(integrate(mesh, quadrature, circle.monomial(2, 0)), whole, 1e-15);
  }
}

TEST(QuadratureBlocks, tell_cells_and_points_apart) {
  const Circle circle{0.5, 0.5, 1.0 / 3};
  const mesh::Mesh mesh = square(0);
  const View<const LocalIndex*> cells = patch_cells(mesh);
  const CellQuadrature quadrature = make_quadrature(mesh, cells, 3, circle.level_set(), 0, 5);
  GlobalIndex points = 0;
  LocalIndex position = 0;
  for_each_block(quadrature, [&](const QuadratureBlock& block) {
    EXPECT_EQ(block.first, position);
    for (LocalIndex k = 0; k < block.cells; ++k, ++position) {
      const LocalIndex K = block.cell(k);
      EXPECT_EQ(K, cells(position));
      if (block.own_rule(k) < 0) {
        EXPECT_EQ(block.offset(k + 1) - block.offset(k), static_cast<int>(quadrature.rule_weight.extent(0)));
      }
      for (int q = block.offset(k); q < block.offset(k + 1); ++q) {
        const double barycentric[3] = {1 - block.xi(q, 0) - block.xi(q, 1), block.xi(q, 0), block.xi(q, 1)};
        double x = 0, y = 0;
        for (int i = 0; i < 3; ++i) {
          x += barycentric[i] * mesh.coordinates(mesh.cell_vertices(K, i), 0);
          y += barycentric[i] * mesh.coordinates(mesh.cell_vertices(K, i), 1);
        }
        EXPECT_NEAR(block.x(q), x, 1e-15);
        EXPECT_NEAR(block.y(q), y, 1e-15);
      }
    }
    points += block.points;
  });
  EXPECT_EQ(position, quadrature.cells());
  EXPECT_EQ(points, quadrature.points());
}

TEST(CellQuadrature, moves_with_the_time_of_the_level_set) {
  const mesh::Mesh mesh = square(1);
  const FieldPtr moving = scene::formula([](double x, double y, double t) { return std::hypot(x - 0.5, y - 0.5) - 0.2 - t; });
  const Circle later{0.5, 0.5, 0.3};
  const CellQuadrature quadrature = make_quadrature(mesh, owned_cells(mesh), 4, moving, 0.1);
  EXPECT_NEAR(integrate(mesh, quadrature, later.monomial(0, 0)) / later.moment(0, 0), 1, 1e-10);
}

TEST(CellQuadrature, throws_on_all_ranks_if_the_level_set_is_not_finite_somewhere) {
  const mesh::Mesh mesh = square(0);
  const FieldPtr broken =
      scene::formula([](double x, double y) { return x > 0.9 && y > 0.9 ? std::log(-1.0) : x - 0.3; }, "scene/interface");
  EXPECT_THROW(make_quadrature(mesh, owned_cells(mesh), 4, broken), core::InputError);
  EXPECT_THROW(make_quadrature(mesh, owned_cells(mesh), 31, nullptr), core::InputError);
}

}  // namespace
}  // namespace thixis::method
