#pragma once
#include "laws/laws.hpp"
#include "thixis/algebra/tpetra.hpp"

/// What a step of Newton's method for two-phase flow may be (docs/methods/two_phase.md, 4).
namespace thixis::flow {

/// max_i |r_i|/max_j |a_ij|: by how much the residual r of A y = b moves the unknown that a row holds, in the units of y. Collective.
double largest_left(const algebra::Matrix& A, const algebra::Vector& r);

/// Where an increment of the gas saturation from s_g ends: where trapped gas begins to move, at S_gr, and a little above, where its
/// pressure begins to rise, the laws have corners; the tangent of one side says nothing about the other one, so that an increment over a
/// corner ends just beyond it. And no increment exceeds 0.2.
double end_of_saturation(const TwoPhaseLaws& laws, double s_g, double increment);

/// Shortens the increments of the owned cells: of s_g as above, of P and chi to ten times the largest ones in X, at least `unknown`.
/// Whether any was. Collective.
bool shortened(const TwoPhaseLaws& laws, const double unknown[unknowns_per_cell], const algebra::Vector& X, algebra::Vector& dX);

}  // namespace thixis::flow
