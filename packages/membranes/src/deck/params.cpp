#include "thixis/membranes/params.hpp"

namespace thixis::membranes {

const core::Schema<InitialParams>& InitialParams::schema() {
  static const auto s =
      core::Schema<InitialParams>("initial", "Model parabolic membranes: where the membranes are at time 0; without it the exact solution.")
          .parameter("u1", &InitialParams::u1, "Height of the upper membrane at time 0.")
          .parameter("u2", &InitialParams::u2, "Height of the lower membrane at time 0, at most u1.");
  return s;
}

const core::Schema<DataParams>& DataParams::schema() {
  static const auto s =
      core::Schema<DataParams>(
          "data", "The functions of the problem: numbers or expressions of x, y, t, r (distance to the centre), pi and the constants.")
          .parameter("mu1", &DataParams::mu1, "Tension of the upper membrane; positive, without it 1.")
          .parameter("mu2", &DataParams::mu2, "Tension of the lower membrane; positive, without it 1.")
          .parameter("f1", &DataParams::f1, "Force on the upper membrane; without it 0.")
          .parameter("f2", &DataParams::f2, "Force on the lower membrane; without it 0.")
          .parameter("g1", &DataParams::g1, "Height of the upper membrane on the boundary; without it that of u1.")
          .parameter("g2", &DataParams::g2, "Height of the lower membrane on the boundary, at most g1; without it that of u2.")
          .parameter("u1", &DataParams::u1, "Exact solution, upper membrane, if known.")
          .parameter("u2", &DataParams::u2, "Exact solution, lower membrane, if known.")
          .parameter("u1_x", &DataParams::u1_x, "Derivative of u1 in x; without it differences of u1.")
          .parameter("u1_y", &DataParams::u1_y, "Derivative of u1 in y; without it differences of u1.")
          .parameter("u2_x", &DataParams::u2_x, "Derivative of u2 in x; without it differences of u2.")
          .parameter("u2_y", &DataParams::u2_y, "Derivative of u2 in y; without it differences of u2.")
          .parameter("mu", &DataParams::mu, "Model obstacle: tension of the membrane; positive, without it 1.")
          .parameter("f", &DataParams::f, "Model obstacle: force on the membrane; without it 0.")
          .parameter("g", &DataParams::g, "Model obstacle: height of the membrane on the boundary, at least psi; without it that of u.")
          .parameter("psi", &DataParams::psi,
                     "Model obstacle: height of the obstacle; must be given. It should be continuous; on an edge where it jumps the upper "
                     "height counts.")
          .parameter("u", &DataParams::u, "Model obstacle: exact solution, if known.")
          .parameter("u_x", &DataParams::u_x, "Model obstacle: derivative of u in x; without it differences of u.")
          .parameter("u_y", &DataParams::u_y, "Model obstacle: derivative of u in y; without it differences of u.")
          .parameter("lambda", &DataParams::lambda, "Exact multiplier, if known.")
          .block("initial", &DataParams::initial, InitialParams::schema())
          .parameter(
              "degree", &DataParams::degree, core::between(0, 30),
              "Names the data as exact: mu, f, g, t and psi are polynomials of at most this degree (in x and y, and in t) in every "
              "cell of the mesh, or on either side of the interface: then the bound is up to quadrature of the data all the same. Not "
              "needed where an expression is one polynomial: that is seen. "
              "docs/methods/estimates.md, 8, has what it is good for.")
          .parameter("centre", &DataParams::centre, core::entries(2), "The point from which r is measured.")
          .values("constants", &DataParams::constants,
                  "Named numbers that the expressions of this block, of 'interface' and of 'boundary' may use.");
  return s;
}

const core::Schema<BoundaryParams>& BoundaryParams::schema() {
  static const auto s =
      core::Schema<BoundaryParams>("boundary",
                                   "One sublist per boundary tag; other parts are dirichlet with g1, g2 (model obstacle: g) of the data.")
          .choice("kind", &BoundaryParams::kind, {{"dirichlet", BoundaryKind::dirichlet}, {"neumann", BoundaryKind::neumann}},
                  "dirichlet: u1 = g1, u2 = g2; neumann: mu1 du1/dn = t1, mu2 du2/dn = t2, n outward; model obstacle: the same without "
                  "indices.")
          .parameter("g1", &BoundaryParams::g1, "Of kind dirichlet: height of the upper membrane; without it g1 of the data.")
          .parameter("g2", &BoundaryParams::g2, "Of kind dirichlet: height of the lower membrane; without it g2 of the data.")
          .parameter("t1", &BoundaryParams::t1, "Of kind neumann: force per length on the upper membrane; without it 0.")
          .parameter("t2", &BoundaryParams::t2, "Of kind neumann: force per length on the lower membrane; without it 0.")
          .parameter("g", &BoundaryParams::g, "Of kind dirichlet, model obstacle: height of the membrane; without it g of the data.")
          .parameter("t", &BoundaryParams::t, "Of kind neumann, model obstacle: force per length on the membrane; without it 0.");
  return s;
}

const core::Schema<SceneParams>& SceneParams::schema() {
  static const auto s =
      core::Schema<SceneParams>("scene", "Membranes.")
          .block("data", &SceneParams::data, DataParams::schema())
          .parameter("interface", &SceneParams::interface,
                     "Expression whose zero set are the curves across which data jump, a product for several; integrals follow them in the "
                     "cells that they are seen to cut.")
          .blocks("boundary", &SceneParams::boundary, BoundaryParams::schema());
  return s;
}

const core::Schema<StartParams>& StartParams::schema() {
  static const auto s = core::Schema<StartParams>("initial",
                                                  "Functions that a cold start begins with; what is not given is zero inside, or the "
                                                  "height closest to zero at which the membranes are held.")
                            .parameter("u", &StartParams::u, "Start of the membrane of the obstacle problem.")
                            .parameter("u1", &StartParams::u1, "Start of the upper membrane.")
                            .parameter("u2", &StartParams::u2, "Start of the lower membrane.")
                            .parameter("lambda", &StartParams::lambda, "Start of the multiplier.");
  return s;
}

const core::Schema<NewtonParams>& NewtonParams::schema() {
  static const auto s = core::Schema<NewtonParams>("newton", "Membranes.").block("initial", &NewtonParams::initial, StartParams::schema());
  return s;
}

}  // namespace thixis::membranes
