#include "thixis/reference/lagrange.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "thixis/core/error.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::reference {
namespace {

std::vector<LagrangeBasis> all_bases() {
  std::vector<LagrangeBasis> bases;
  for (int degree = 1; degree <= 4; ++degree)
    for (const Nodes nodes : {Nodes::equispaced, Nodes::gauss_lobatto}) bases.emplace_back(degree, nodes);
  return bases;
}

TEST(LagrangeBasis, is_one_at_its_node_and_zero_at_the_others) {
  for (const LagrangeBasis& basis : all_bases()) {
    EXPECT_EQ(basis.size(), (basis.degree() + 1) * (basis.degree() + 2) / 2);
    const Tabulation at_nodes = basis.tabulate(basis.size(), basis.points().data());
    for (int m = 0; m < basis.size(); ++m)
      for (int l = 0; l < basis.size(); ++l) EXPECT_NEAR(at_nodes.value[m * basis.size() + l], l == m ? 1 : 0, 1e-13);
  }
}

TEST(LagrangeBasis, reproduces_polynomials_of_its_degree_and_their_gradients) {
  const Quadrature rule = triangle_quadrature(7);
  for (const LagrangeBasis& basis : all_bases()) {
    const Tabulation table = basis.tabulate(rule.size(), rule.point.data());
    const int p = basis.degree(), n = basis.size();
    for (int a = 0; a <= p; ++a)
      for (int b = 0; a + b <= p; ++b)
        for (int q = 0; q < rule.size(); ++q) {
          double value = 0, dxi = 0, deta = 0;
          for (int l = 0; l < n; ++l) {
            const double node = std::pow(basis.points()[2 * l], a) * std::pow(basis.points()[2 * l + 1], b);
            value += node * table.value[q * n + l];
            dxi += node * table.gradient[2 * (q * n + l)];
            deta += node * table.gradient[2 * (q * n + l) + 1];
          }
          const double xi = rule.point[2 * q], eta = rule.point[2 * q + 1];
          EXPECT_NEAR(value, std::pow(xi, a) * std::pow(eta, b), 1e-13);
          EXPECT_NEAR(dxi, a == 0 ? 0 : a * std::pow(xi, a - 1) * std::pow(eta, b), 1e-12);
          EXPECT_NEAR(deta, b == 0 ? 0 : b * std::pow(xi, a) * std::pow(eta, b - 1), 1e-12);
        }
  }
}

TEST(LagrangeBasis, sums_to_one_and_its_gradients_to_zero) {
  const Quadrature rule = triangle_quadrature(5);
  for (const LagrangeBasis& basis : all_bases()) {
    const Tabulation table = basis.tabulate(rule.size(), rule.point.data());
    for (int q = 0; q < rule.size(); ++q) {
      double sum = 0, dxi = 0, deta = 0;
      for (int l = 0; l < basis.size(); ++l) {
        sum += table.value[q * basis.size() + l];
        dxi += table.gradient[2 * (q * basis.size() + l)];
        deta += table.gradient[2 * (q * basis.size() + l) + 1];
      }
      EXPECT_NEAR(sum, 1, 1e-14);
      EXPECT_NEAR(dxi, 0, 1e-13);
      EXPECT_NEAR(deta, 0, 1e-13);
    }
  }
}

TEST(LagrangeBasis, knows_the_entity_of_every_node) {
  for (const LagrangeBasis& basis : all_bases()) {
    int of_vertex[3] = {0, 0, 0}, of_face[3] = {0, 0, 0}, inside = 0;
    for (int l = 0; l < basis.size(); ++l) {
      const double xi = basis.points()[2 * l], eta = basis.points()[2 * l + 1];
      const double barycentric[3] = {1 - xi - eta, xi, eta};
      const auto [kind, index] = basis.entities()[l];
      if (kind == Entity::vertex) {
        ++of_vertex[index];
        EXPECT_EQ(barycentric[index], 1);
      } else if (kind == Entity::face) {
        ++of_face[index];
        EXPECT_NEAR(barycentric[index], 0, 1e-15);
      } else {
        ++inside;
        EXPECT_GT(*std::min_element(barycentric, barycentric + 3), 0.1);
      }
    }
    const int p = basis.degree();
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(of_vertex[i], 1);
      EXPECT_EQ(of_face[i], p - 1);
    }
    EXPECT_EQ(inside, (p - 1) * (p - 2) / 2);
  }
}

TEST(LagrangeBasis, numbers_face_nodes_from_vertex_i_plus_1_to_i_plus_2) {
  for (const LagrangeBasis& basis : all_bases()) {
    const int p = basis.degree();
    for (int i = 0; i < 3; ++i) {
      double before = 0;
      for (int k = 0; k < p - 1; ++k) {
        const int l = 3 + i * (p - 1) + k;
        const double xi = basis.points()[2 * l], eta = basis.points()[2 * l + 1];
        const double barycentric[3] = {1 - xi - eta, xi, eta};
        EXPECT_GT(barycentric[(i + 2) % 3], before);
        before = barycentric[(i + 2) % 3];
        const int mirrored = 3 + i * (p - 1) + (p - 2 - k);
        const double other[3] = {1 - basis.points()[2 * mirrored] - basis.points()[2 * mirrored + 1], basis.points()[2 * mirrored],
                                 basis.points()[2 * mirrored + 1]};
        EXPECT_NEAR(other[(i + 1) % 3], barycentric[(i + 2) % 3], 1e-15) << "two cells could not share the nodes of a face";
      }
    }
  }
}

TEST(LagrangeBasis, states_the_integrals_of_its_functions) {
  for (const LagrangeBasis& basis : all_bases()) {
    const Quadrature rule = triangle_quadrature(basis.degree());
    const Tabulation table = basis.tabulate(rule.size(), rule.point.data());
    for (int l = 0; l < basis.size(); ++l) {
      double integral = 0;
      for (int q = 0; q < rule.size(); ++q) integral += rule.weight[q] * table.value[q * basis.size() + l];
      EXPECT_NEAR(basis.integrals()[l], integral, 1e-14);
    }
  }
}

TEST(LagrangeBasis, has_no_negative_mean_on_gauss_lobatto_nodes) {
  for (int degree = 1; degree <= 4; ++degree) {
    const LagrangeBasis basis(degree, Nodes::gauss_lobatto);
    for (const double integral : basis.integrals()) EXPECT_GT(integral, -1e-15) << "degree " << degree;
  }
}

TEST(LagrangeBasis, has_negative_means_at_the_middle_of_the_faces_for_equispaced_p4) {
  const LagrangeBasis basis(4, Nodes::equispaced);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(2 * basis.integrals()[3 + 3 * i + 1], -1.0 / 45, 1e-14);
}

TEST(LagrangeBasis, refuses_degrees_it_does_not_have) {
  EXPECT_THROW(LagrangeBasis(0, Nodes::equispaced), core::InputError);
  EXPECT_THROW(LagrangeBasis(5, Nodes::gauss_lobatto), core::InputError);
}

}  // namespace
}  // namespace thixis::reference
