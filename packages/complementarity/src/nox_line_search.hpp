#pragma once
#include <NOX_LineSearch_Generic.H>
#include <NOX_LineSearch_UserDefinedFactory.H>

namespace thixis::complementarity {

/// Armijo's rule for the merit function ½|R|² along a Newton direction, whose slope is -|R|²: the largest t = 1, 1/2, 1/4, ... with
///
///     ½|R(X + t d)|² <= ½|R(X)|² - σ t |R(X)|²,   σ = 1e-4.
///
/// A residual that is not finite is no decrease. Throws StepFailed, with the group back at X, if t falls below 1e-8.
class Armijo : public NOX::LineSearch::Generic {
 public:
  bool compute(NOX::Abstract::Group& group, double& step, const NOX::Abstract::Vector& direction,
               const NOX::Solver::Generic& solver) override;

  class Factory : public NOX::LineSearch::UserDefinedFactory {
   public:
    Teuchos::RCP<NOX::LineSearch::Generic> buildLineSearch(const Teuchos::RCP<NOX::GlobalData>&, Teuchos::ParameterList&) const override {
      return Teuchos::rcp(new Armijo);
    }
  };
};

}  // namespace thixis::complementarity
