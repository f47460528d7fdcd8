#include "thixis/dg/entry.hpp"

#include "thixis/dg/params.hpp"
#include "thixis/dg/space.hpp"

namespace thixis::dg {

const core::Schema<Params>& Params::schema() {
  static const auto schema =
      core::Schema<Params>("method", "Discontinuous Galerkin.")
          .choice("variant", &Params::variant, {{"sipg", Variant::sipg}, {"nipg", Variant::nipg}},
                  "dg: symmetric or non-symmetric interior penalty.")
          .parameter("penalty", &Params::penalty, core::above(0), "dg: eta in the penalty eta p^2/|F| of the jumps (docs/methods/dg.md).")
          .choice("boundary", &Params::boundary, {{"weak", BoundaryTreatment::weak}, {"strong", BoundaryTreatment::strong}},
                  "dg: Dirichlet data enter through the forms on the boundary, or fix the nodes there.");
  return schema;
}

method::Method entry() {
  method::Method dg;
  dg.name = "dg";
  dg.title = "discontinuous Galerkin";
  dg.uses = {"method/degree", "method/nodes", "method/quadrature order", "method/variant", "method/penalty", "method/boundary"};
  dg.describe = [](core::Schema<method::MethodParams>& block) { block.with(&method::MethodParams::own, Params::schema()); };
  dg.make_space = make_space;
  dg.diffusion = diffusion;
  dg.check_mesh = check_mesh;
  dg.symmetry = {[](const method::MethodParams& params) { return params.own.get<Params>().variant == Variant::sipg; },
                 "method/variant = sipg", "nipg", "the variant 'sipg'"};
  dg.unknowns_per_cell = [](const method::MethodParams& params) { return (params.degree + 1) * (params.degree + 2) / 2.0; };
  return dg;
}

}  // namespace thixis::dg
