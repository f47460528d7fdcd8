#include "data/change_of_force.hpp"

#include <array>
#include <vector>

#include "data/on_host.hpp"
#include "thixis/bound/cell_fields.hpp"

namespace thixis::bound {
namespace {

constexpr int parts = 32;
constexpr GlobalIndex most_looked_at = 1000;  ///< cells
constexpr double place[3] = {0.1127016653792583, 0.5, 0.8872983346207417}, weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};

/// The mean over time of |f(t) - f(end)|² at one point of some cells, every so many of all ids, as two rules have it.
struct Look {
  double gauss = 0, fine = 0;
  double size = 0;  ///< of |f(end)|²: what changes by no more than round-off of it does not change
  bool resolved() const { return fine <= 2 * gauss + 1e-24 * size; }
};

Look look(const method::Space& space, const scene::Field& force, double begin, double end) {
  const auto& mesh = space.mesh();
  const GlobalIndex stride = 1 + (mesh.global_cells - 1) / most_looked_at;
  std::vector<double> x, y;
  method::for_each_block(space.quadrature(), [&](const method::QuadratureBlock& block) {
    const auto offset = on_host(block.offset);
    const auto at_x = on_host(block.x), at_y = on_host(block.y);
    for (LocalIndex c = 0; c < block.cells && block.first + c < mesh.owned_cells; ++c)
      if (mesh.cell_id[block.first + c] % stride == 0) {
        x.push_back(at_x(offset(c)));
        y.push_back(at_y(offset(c)));
      }
  });
  const auto values = [&](double t) {
    std::vector<double> f(x.size());
    force.evaluate({x.size(), x.data(), y.data()}, t, f.data());
    return f;
  };
  const auto last = values(end);
  const auto squares = [&](double theta) {
    const auto f = values(begin + theta * (end - begin));
    double sum = 0;
    for (std::size_t i = 0; i < f.size(); ++i) sum += (f[i] - last[i]) * (f[i] - last[i]);
    return sum;
  };
  Look found;
  for (const double f : last) found.size += f * f;
  for (int g = 0; g < 3; ++g) found.gauss += weight[g] * squares(place[g]);
  for (int k = 0; k < parts; ++k) found.fine += squares((k + 0.5) / parts) / parts;
  return found;
}

/// Gauss' rule with three points on each of so many parts of the step.
double integral(const method::Space& space, const scene::Field& force, double begin, double end, int pieces) {
  const auto& quadrature = space.quadrature();
  const LocalIndex owned = space.mesh().owned_cells;
  const View<double*> at_end("thixis::bound::force_at_end", quadrature.largest_block),
      between("thixis::bound::force_between", quadrature.largest_block);
  double sum = 0;
  method::for_each_block(quadrature, [&](const method::QuadratureBlock& block) {
    if (block.first >= owned) return;
    method::evaluate(force, end, block, at_end);
    const auto offset = on_host(block.offset);
    const auto weights = on_host(block.weight);
    const auto last = on_host(at_end);
    for (int k = 0; k < 3 * pieces; ++k) {
      const int piece = k / 3;
      method::evaluate(force, begin + (piece + place[k % 3]) / pieces * (end - begin), block, between);
      const auto now = on_host(between);
      for (LocalIndex c = 0; c < block.cells && block.first + c < owned; ++c)
        for (int i = offset(c); i < offset(c + 1); ++i)
          sum += weight[k % 3] / pieces * weights(i) * (now(i) - last(i)) * (now(i) - last(i));
    }
  });
  return (end - begin) * sum;
}

}  // namespace

ForceChange change_of_force(const method::Space& space, const scene::Field& force, double begin, double end) {
  if (force.steady()) return {};
  const core::Comm& comm = space.mesh().comm;
  Look seen;
  comm.together([&] { seen = look(space, force, begin, end); });
  ForceChange change;
  change.resolved = Look{comm.sum(seen.gauss), comm.sum(seen.fine), comm.sum(seen.size)}.resolved();
  comm.together([&] { change.square = integral(space, force, begin, end, change.resolved ? 1 : parts); });
  return change;
}

}  // namespace thixis::bound
