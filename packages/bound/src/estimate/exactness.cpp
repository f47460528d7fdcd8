#include "estimate/exactness.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "lift/lift_tables.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::bound {
namespace {

using scene::Degree;

/// How the curves along which pieces meet lie in the mesh.
enum class Interface {
  none,    ///< pieces meet at faces
  unseen,  ///< no cell has points on either side of it, which does not prove that none is cut
  cuts     ///< some cell has
};

std::string words(int degree) { return degree < Degree::most ? std::to_string(degree) : fmt::format("{} or more", Degree::most); }

/// The clause for a function of this degree whose integrals need a rule of `order`. A rule that follows an interface loses one order.
std::string needs_order(const std::string& name, int degree, int order, int highest = reference::max_quadrature_order) {
  if (order > highest) return fmt::format("{} has degree {}, for which no method/quadrature order is enough", name, words(degree));
  return fmt::format("{} has degree {}, which takes method/quadrature order = {}", name, words(degree), order);
}

/// Collects the clauses.
class Examination {
 public:
  Examination(const method::Space& space, int q, Interface interface, bool lift)
      : highest_(reference::max_quadrature_order - (interface == Interface::cuts ? 1 : 0)),
        order_(std::min(space.quadrature().order, highest_)),
        p_(space.basis().degree()),
        q_(q),
        interface_(interface),
        lift_(lift) {}

  /// Sources: moments against P_{q+1}, the square of what is left. Loads and tractions alike.
  void source(const std::string& name, const scene::Field& f) {
    if (const auto d = known(name, f)) integrated(name, d->space, std::max(2 * d->space, d->space + q_ + 1));
  }
  /// The flux term |mu grad u + sigma|² times a polynomial that bounds 1/mu; the lift's own rule serves degree 2.
  void tension(const std::string& name, const scene::Field& mu, bool proved) {
    if (mu.constant()) return;
    const auto d = known(name, mu);
    if (!d) return;
    if (!proved) return add(name + " varies too much within some cell");
    integrated(name, d->space, 2 * std::max(d->space + p_ - 1, q_ + 1) + d->space);
    if (lift_ && d->space > 2) add(fmt::format("{} has degree {} where boundary data are lifted, more than 2", name, words(d->space)));
  }
  /// The lift is the data where s (1 - s) q resolves them, q of degree `resolution`.
  void dirichlet(const std::string& name, const scene::Field& g) {
    constexpr int most = LiftInCell::resolution + 2;
    const auto d = known(name, g);
    if (d && d->space > most) add(fmt::format("{} has degree {} along faces, more than {}", name, words(d->space), most));
  }
  void obstacle(const scene::Field& psi, bool interpolated) {
    const auto d = known("the obstacle", psi);
    if (d && d->space > p_) add(fmt::format("the obstacle has degree {}, more than that of the method", words(d->space)));
    else if (d && !interpolated) add("the obstacle jumps");
  }
  std::vector<std::string> clauses() const { return clauses_; }

 private:
  void add(const std::string& clause) {
    if (std::find(clauses_.begin(), clauses_.end(), clause) == clauses_.end()) clauses_.push_back(clause);
  }
  std::optional<Degree> known(const std::string& name, const scene::Field& field) {
    const auto degree = field.degree();
    if (!degree) add(name + " is not known to be a polynomial in every cell");
    else if (!degree->whole && interface_ == Interface::cuts) add(name + " may jump inside of cells, which the interface cuts");
    else if (!degree->whole && interface_ == Interface::unseen)
      add(name +
          " is made of pieces, and no cell is proved to lie on one side of the interface; where they meet at faces of the mesh "
          "leave scene/interface out");
    else return degree;
    return {};
  }
  void integrated(const std::string& name, int degree, int order) {
    if (order > order_) add(needs_order(name, degree, order, highest_));
  }

  int highest_, order_, p_, q_;
  Interface interface_;
  bool lift_;
  std::vector<std::string> clauses_;
};

/// Collective.
Interface interface_of(const method::Space& space, const ContactProblem& problem) {
  if (space.mesh().comm.any(space.quadrature().cut_cells() > 0)) return Interface::cuts;
  return problem.interface && problem.interface->constant() == nullptr ? Interface::unseen : Interface::none;
}

}  // namespace

std::vector<std::string> doubts(const method::Space& space, const ContactProblem& problem, int q, const bool (&proved)[2],
                                const FeasiblePair& pair) {
  Examination examine(space, q, interface_of(space, problem), pair.boundary_energy() > 0);
  for (int alpha = 0; alpha < problem.count; ++alpha) {
    const auto name = [&](const std::string& what) { return problem.count == 1 ? "the " + what : fmt::format("{} {}", what, alpha + 1); };
    examine.source(name("force"), *problem.force[alpha]);
    examine.tension(name("tension"), *problem.tension[alpha], proved[alpha]);
    for (const auto& g : problem.boundary[alpha].dirichlet)
      if (g) examine.dirichlet(name("height on the boundary"), *g);
    for (const auto& t : problem.boundary[alpha].neumann)
      if (t) examine.source(name("traction"), *t);
  }
  if (problem.obstacle) examine.obstacle(*problem.obstacle, pair.obstacle_is_interpolated());
  return examine.clauses();
}

std::vector<std::string> doubts_in_time(const ContactProblem& problem, const FeasiblePair& before, const FeasiblePair& after) {
  std::vector<std::string> clauses;
  const auto examine = [&](const std::string& name, const scene::Field& field, int most) {
    const auto degree = field.degree();
    if (field.steady() || !degree) return;  // of the latter there is a doubt already
    std::string clause;
    if (!degree->whole) clause = name + " may jump in time";
    else if (degree->time > most) clause = fmt::format("{} has degree {} in t, more than {}", name, words(degree->time), most);
    if (!clause.empty() && std::find(clauses.begin(), clauses.end(), clause) == clauses.end()) clauses.push_back(clause);
  };
  for (int alpha = 0; alpha < problem.count; ++alpha) {
    examine(fmt::format("force {}", alpha + 1), *problem.force[alpha], 2);
    for (const auto& g : problem.boundary[alpha].dirichlet)
      if (g) examine(fmt::format("height on the boundary {}", alpha + 1), *g, 1);
  }
  if (problem.interface && !problem.interface->steady()) clauses.emplace_back("the interface moves");
  if (before.boundary_energy() > 0 || after.boundary_energy() > 0)
    clauses.emplace_back("boundary data are no polynomials of the degree of the method");
  return clauses;
}

std::vector<std::string> doubts_at_start(const method::Space& space, int alpha, const scene::Field& initial) {
  const auto degree = initial.degree();
  const std::string name = fmt::format("the initial height {}", alpha + 1);
  if (!degree || !degree->whole) return {name + " is not known to be a polynomial"};
  const int order = 2 * std::max(degree->space, space.basis().degree());
  if (order <= space.quadrature().order) return {};
  return {needs_order(name, degree->space, order)};
}

}  // namespace thixis::bound
