#include "thixis/hho/entry.hpp"

#include "thixis/hho/params.hpp"
#include "thixis/hho/space.hpp"

namespace thixis::hho {

const core::Schema<Params>& Params::schema() {
  static const auto schema =
      core::Schema<Params>("method", "Hybrid high-order.")
          .parameter("stabilization", &Params::stabilization, core::between(1, 1e6),
                     "hho: kappa in the stabilization kappa/h of the differences between cell and face; below 1 the error would grow like "
                     "1/kappa, and nothing would be gained (docs/methods/hho.md, 4).")
          .choice("stabilization length", &Params::stabilization_length,
                  {{"face", StabilizationLength::face}, {"cell", StabilizationLength::cell}},
                  "hho: h is the length of the face, or the diameter of the cell.");
  return schema;
}

method::Method entry() {
  method::Method hho;
  hho.name = "hho";
  hho.title = "hybrid high-order";
  hho.uses = {"method/degree", "method/nodes", "method/quadrature order", "method/stabilization", "method/stabilization length"};
  hho.describe = [](core::Schema<method::MethodParams>& block) { block.with(&method::MethodParams::own, Params::schema()); };
  hho.make_space = make_space;
  hho.diffusion = diffusion;
  hho.interior = {[](const method::MethodParams&) { return true; }, "", true};
  hho.bounded_in_time = true;
  hho.unknowns_per_cell = [](const method::MethodParams& params) {
    const double p = params.degree;
    return 1.5 * (p + 1) + (p + 1) * (p + 2) / 2;
  };
  return hho;
}

}  // namespace thixis::hho
