#include "step/step_begin.hpp"

#include "step/way_density.hpp"

namespace thixis::bound {

void begin_step(const BoundParts& parts, const method::Coefficients (&u)[2], const CellTable& remaining, StepBegin& of) {
  const FeasiblePair& pair = *of.feasible;
  of.s_c = pair.continuous(u);
  of.way = pair.way(u, of.s_c);
  pair.evaluate(u, CellTable("thixis::bound::no_multiplier", parts.owned(), 0), parts.q, of.pair);
  for (int alpha = 0; alpha < parts.problem.count; ++alpha) {
    StepBegin::Membrane& m = of.membrane[alpha];
    m.u = u[alpha];
    if (m.w.extent(0) == 0)
      m.w = CellTable("thixis::bound::stress_before", parts.membrane[alpha].w.extent(0), parts.membrane[alpha].w.extent(1));
    (*parts.membrane[alpha].stress)(u[alpha], m.w);
    const CellTable &averages = of.way.averages[alpha], &closing = of.way.closing[alpha];
    if (averages.extent(0) > 0 && closing.extent(0) > 0) add(1, closing, averages);
    m.moved = averages.extent(0) > 0 ? averages : closing;
    m.sigma = {};
    m.left = 0;
    if (!parts.discretization.on_patches() || !density_of(parts.metric, -1 / of.tau(), m.moved, 0, {}, remaining)) continue;
    m.sigma = CellTable("thixis::bound::sigma_before", parts.owned(), parts.membrane[alpha].disc.extent(1));
    m.left = parts.lift.flux(remaining, m.sigma);
  }
}

std::size_t StepBegin::bytes() const {
  std::size_t tables = way.gap.size();
  for (const Membrane& m : membrane) tables += m.u.size() + m.w.size() + m.moved.size() + m.sigma.size();
  return sizeof(double) * tables;
}

}  // namespace thixis::bound
