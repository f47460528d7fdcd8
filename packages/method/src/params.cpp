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
                  "Where contact is imposed: at the nodes of a Lagrange basis (gauss-lobatto: none of its functions has a negative mean), "
                  "or on the "
                  "Bernstein coefficients of the gap, which keeps it non-negative everywhere (over an obstacle: above its interpolant). "
                  "All the same for fem of degree 1.")
          .parameter("quadrature order", &MethodParams::quadrature_order, core::between(0, 30),
                     "Degree up to which loads and errors are integrated exactly; 0 stands for 2 degree + 4, and less than 2 degree for "
                     "that. Cells that the scene's interface "
                     "cuts are divided along it.")
          .choice("variant", &MethodParams::variant, {{"sipg", Variant::sipg}, {"nipg", Variant::nipg}},
                  "dg: symmetric or non-symmetric interior penalty.")
          .parameter("penalty", &MethodParams::penalty, core::above(0),
                     "dg: eta in the penalty eta p^2/|F| of the jumps (docs/methods/dg.md).")
          .choice("boundary", &MethodParams::boundary, {{"weak", BoundaryTreatment::weak}, {"strong", BoundaryTreatment::strong}},
                  "dg: Dirichlet data enter through the forms on the boundary, or fix the nodes there.")
          .parameter(
              "condensation", &MethodParams::condensation,
              "Whether the unknowns inside the cells are eliminated from the linear systems, contact included: possible for hho, and for "
              "fem of degree 3 and 4. Not given: true for hho. The systems are then reduced ones, whatever linear/form says.")
          .parameter("stabilization", &MethodParams::stabilization, core::between(1, 1e6),
                     "hho: kappa in the stabilization kappa/h of the differences between cell and face; below 1 the error would grow like "
                     "1/kappa, and nothing would be gained (docs/methods/hho.md, 4).")
          .choice("stabilization length", &MethodParams::stabilization_length,
                  {{"face", StabilizationLength::face}, {"cell", StabilizationLength::cell}},
                  "hho: h is the length of the face, or the diameter of the cell.");
  return schema;
}

}  // namespace thixis::method
