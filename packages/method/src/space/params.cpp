#include <cctype>

#include "thixis/method/method.hpp"

namespace thixis::method {
namespace {

using core::Schema;

/// "Continuous finite elements, discontinuous Galerkin, or finite volumes."
std::string titles(const std::vector<Method>& methods) {
  std::string text;
  for (std::size_t i = 0; i < methods.size(); ++i)
    text += (i == 0 ? "" : i + 1 < methods.size() ? ", " : methods.size() > 2 ? ", or " : " or ") + methods[i].title;
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text + ".";
}

/// "hho, and for fem of method/degree = 3 or 4"
std::string with_interior(const std::vector<Method>& methods) {
  std::string always, sometimes;
  for (const Method& method : methods) {
    if (!method.interior.exists) continue;
    if (method.interior.condition.empty()) always += (always.empty() ? "" : ", ") + method.name;
    else sometimes += (sometimes.empty() ? "" : ", ") + method.name + " with " + method.interior.condition;
  }
  return always + (always.empty() || sometimes.empty() ? "" : ", and for ") + sometimes;
}

std::string condensed_by_default(const std::vector<Method>& methods) {
  std::string names;
  for (const Method& method : methods)
    if (method.interior.condensed) names += (names.empty() ? "" : ", ") + method.name;
  return names.empty() ? "false" : "true for " + names;
}

Schema<MethodParams> shared_by(const std::vector<Method>& methods, const MethodParams& defaults) {
  std::vector<std::pair<std::string, std::string>> names;
  for (const Method& method : methods) names.emplace_back(method.name, method.name);
  return Schema<MethodParams>("method", "How the scene is discretized.", defaults)
      .choice("name", &MethodParams::name, names, titles(methods))
      .parameter("degree", &MethodParams::degree, core::between(1, 4), "Polynomial degree p of the fields.")
      .choice("nodes", &MethodParams::nodes,
              {{"gauss-lobatto", Nodes::gauss_lobatto}, {"equispaced", Nodes::equispaced}, {"bernstein", Nodes::bernstein}},
              "Where contact is imposed: at the nodes of a Lagrange basis (gauss-lobatto: none of its functions has a negative mean), "
              "or on the Bernstein coefficients of the gap, which keeps it non-negative everywhere (over an obstacle: above its "
              "interpolant). All the same for continuous elements of degree 1.")
      .parameter("quadrature order", &MethodParams::quadrature_order, core::between(0, 30),
                 "Degree up to which loads and errors are integrated exactly; 0 stands for 2 degree + 4, and less than 2 degree for "
                 "that. Cells that the scene's interface cuts are divided along it.")
      .parameter("condensation", &MethodParams::condensation,
                 "Whether the unknowns inside the cells are eliminated from the linear systems, contact included: possible for " +
                     with_interior(methods) + ". Not given: " + condensed_by_default(methods) +
                     ". The systems are then reduced ones, whatever linear/form says.");
}

}  // namespace

Schema<MethodParams> schema_of(const std::vector<Method>& methods) {
  MethodParams defaults;
  if (!methods.empty()) defaults.name = methods.front().name;
  Schema<MethodParams> schema = shared_by(methods, defaults);
  for (const Method& method : methods)
    if (method.describe) method.describe(schema);
  return schema;
}

}  // namespace thixis::method
