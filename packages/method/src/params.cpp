#include "thixis/method/space.hpp"

namespace thixis::method {
namespace {

const std::vector<std::pair<std::string, MethodName>> names = {
    {"fem", MethodName::fem}, {"dg", MethodName::dg}, {"hho", MethodName::hho}, {"fv", MethodName::fv}};

}  // namespace

std::string to_text(MethodName name) { return names[static_cast<std::size_t>(name)].first; }

const core::Schema<MethodParams>& MethodParams::schema() {
  static const auto schema =
      core::Schema<MethodParams>("method", "How the scene is discretized.")
          .choice("name", &MethodParams::name, names,
                  "Continuous finite elements, discontinuous Galerkin, hybrid high-order, or finite volumes.")
          .parameter("degree", &MethodParams::degree, core::between(1, 4), "Polynomial degree p of the fields.")
          .choice("nodes", &MethodParams::nodes,
                  {{"gauss-lobatto", Nodes::gauss_lobatto}, {"equispaced", Nodes::equispaced}, {"bernstein", Nodes::bernstein}},
                  "Nodes of the Lagrange basis, at which contact is imposed; all the same for degree 1.")
          .parameter(
              "quadrature order", &MethodParams::quadrature_order, core::between(0, 30),
              "Degree up to which loads and errors are integrated exactly; 0 stands for 2 degree + 4. Cells that the scene's interface "
              "cuts are divided along it.");
  return schema;
}

}  // namespace thixis::method
