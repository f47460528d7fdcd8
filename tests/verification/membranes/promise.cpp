/// What bounds promise: where one says 'guaranteed' it is not below the error, whatever the data are, and polynomial data make it say so.
/// Errors are judged by rules of order 30 that follow the kinks of the exact solution, which those of the bound need not know of.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "problems.hpp"
#include "thixis/core/deck.hpp"
#include "thixis/membranes/membranes.hpp"
#include "thixis/method/quadrature.hpp"

namespace thixis::verification {
namespace {

using complementarity::Promise;

using Functions = std::map<std::string, std::string>;

drive::RunParams scene_of(const std::string& model, const Functions& functions, const method::MethodParams& method) {
  auto deck = core::Deck::from_text("<ParameterList name=\"thixis\"/>", "data");
  deck.set("scene/model=" + model);
  for (const auto& [path, text] : functions) deck.set("scene/" + path + "=" + text);
  auto params = deck.parse(catalogue().schema());
  params.mesh.cells_per_side = 2;
  params.mesh.refinements = 1;
  params.method = method;
  params.stopping.estimate = true;
  params.linear.form = algebra::SystemForm::reduced;
  params.linear.solver = algebra::SolverKind::direct;
  return params;
}

struct Judged {
  Promise promise;
  double bound, error;
  bool true_bound() const { return bound >= (1 - 1e-9) * error; }
};

/// `kinks`: a level set of the curves where derivatives of the exact solution jump.
Judged judged(const drive::RunParams& params, const std::string& kinks = "") {
  const Solved run = solve(params);
  EXPECT_TRUE(run.outcome.solved) << run.outcome.finest.why;
  drive::RunParams finer = params;
  finer.method.quadrature_order = 30;
  if (!kinks.empty()) membranes::of(finer.scene).interface.text = kinks;
  const auto model =
      membranes::membranes(membranes::membrane_scene(finer.scene), method_of(finer.method.name), finer.method, finer.linear, {});
  const auto judge = model->discretize(run.hierarchy, run.outcome.at.level);
  return {run.outcome.estimate->promise, run.outcome.estimate->total, *judge->energy_error(*run.outcome.X)};
}

/// Nothing that is called guaranteed may be below the error.
class Record {
 public:
  void add(const Judged& seen, const std::string& what) {
    if (seen.promise == Promise::guaranteed) {
      EXPECT_TRUE(seen.true_bound()) << what << ": 'guaranteed' to be at most " << seen.bound << ", but the error is " << seen.error;
      ++guaranteed;
    }
    ++all;
  }
  int all = 0, guaranteed = 0;
};

class Random {
 public:
  explicit Random(int seed) : engine_(seed) {}
  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  int pick(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }

 private:
  std::mt19937 engine_;
};

/// sum c_ij x^i y^j with its derivatives, as text.
class Polynomial {
 public:
  Polynomial(int degree, Random& random) {
    for (int i = 0; i <= degree; ++i)
      for (int j = 0; i + j <= degree; ++j) terms_.push_back({i, j, random(-1, 1) / (1 + i + j)});
  }
  /// Re ((x + i y)/√2)^n.
  static Polynomial harmonic(int n) {
    Polynomial p;
    double binomial = std::pow(0.5, 0.5 * n);
    for (int k = 0; k <= n; ++k) {
      if (k % 2 == 0) p.terms_.push_back({n - k, k, k % 4 == 0 ? binomial : -binomial});
      binomial *= static_cast<double>(n - k) / (k + 1);
    }
    return p;
  }
  std::string text(int x = 0, int y = 0) const {
    std::string sum = "0";
    for (const auto& [i, j, c] : terms_)
      if (i >= x && j >= y) sum += fmt::format(" + ({:.17g})*x^{}*y^{}", c * falling(i, x) * falling(j, y), i - x, j - y);
    return sum;
  }
  std::string laplacian() const { return "(" + text(2, 0) + " + " + text(0, 2) + ")"; }

 private:
  struct Term {
    int i, j;
    double c;
  };
  Polynomial() = default;
  static double falling(int n, int k) {
    double product = 1;
    for (int m = 0; m < k; ++m) product *= n - m;
    return product;
  }
  std::vector<Term> terms_;
};

/// The upper membrane is u far above the lower one: -div(mu grad u) = f.
Functions far_apart(const std::string& u, const std::string& u_x, const std::string& u_y, const std::string& f,
                    const std::string& mu = "1") {
  return {{"data/u1", u}, {"data/u1_x", u_x}, {"data/u1_y", u_y}, {"data/f1", f}, {"data/mu1", mu}, {"data/u2", "-9"}};
}
Functions far_apart(const Polynomial& u) { return far_apart(u.text(), u.text(1, 0), u.text(0, 1), "-" + u.laplacian()); }

std::vector<std::pair<std::string, method::MethodParams>> methods(int p) { return all_methods(p); }

}  // namespace

TEST(Promise, of_polynomial_data_is_guaranteed_by_every_method) {
  Random random(1);
  Record record;
  for (int p = 1; p <= 3; ++p)
    for (const auto& [name, method] : methods(p)) {
      const int degree = random.pick(1, p + 4);  // force: p + 2 at most; boundary data beyond p are lifted
      const Judged seen = judged(scene_of("membranes", far_apart(Polynomial(degree, random)), method));
      EXPECT_EQ(seen.promise, Promise::guaranteed) << name << ", degree " << degree;
      record.add(seen, name);
    }
  EXPECT_EQ(record.guaranteed, record.all);
}

TEST(Promise, of_boundary_data_is_guaranteed_as_far_as_their_lift_resolves_them) {
  Record record;
  for (const int n : {2, 8, 12, 13, 20}) {
    const Polynomial u = Polynomial::harmonic(n);
    const Judged seen = judged(scene_of("membranes", far_apart(u.text(), u.text(1, 0), u.text(0, 1), "0"), by("fem", 1)));
    EXPECT_EQ(seen.promise == Promise::guaranteed, n <= 12) << n;
    record.add(seen, fmt::format("harmonic of degree {}", n));
  }
}

TEST(Promise, of_tensions_is_guaranteed_where_bernstein_coefficients_bound_their_inverse) {
  Random random(2);
  Record record;
  for (const double a : {0.5, 1e2, 1e4, 1e6})
    for (const auto& [name, method] : {std::pair("fem", by("fem", 1)), std::pair("hho", by("hho", 2)), std::pair("dg", by("dg", 2))}) {
      if (!is_built(method.name)) continue;
      const Polynomial u(2, random);
      const std::string mu = fmt::format("(1 + {}*x^2)", a);
      const auto functions =
          far_apart(u.text(), u.text(1, 0), u.text(0, 1), fmt::format("-{}*{} - 2*{}*x*({})", mu, u.laplacian(), a, u.text(1, 0)), mu);
      const Judged seen = judged(scene_of("membranes", functions, method));
      EXPECT_EQ(seen.promise, Promise::guaranteed) << name << ", " << mu;
      record.add(seen, name + (" with " + mu));
    }
}

TEST(Promise, of_tensions_that_are_no_polynomials_is_none) {
  Record record;
  for (const double k : {1.0, 10.0, 37.0, 60.0})  // by e^k: up to 1e4 and 3e6 within a cell
    for (int p = 1; p <= 2; ++p) {
      const auto functions =
          far_apart("2 + x*y + x^2", "y + 2*x", "x", fmt::format("-exp({0}*x)*({0}*(y + 2*x) + 2)", k), fmt::format("exp({}*x)", k));
      const Judged seen = judged(scene_of("membranes", functions, by("fem", p)));
      EXPECT_EQ(seen.promise, Promise::up_to_quadrature) << k;
      record.add(seen, "exponential tension");
    }
}

TEST(Promise, of_forces_that_quadrature_does_not_resolve_is_none) {
  Random random(3);
  Record record;
  for (int trial = 0; trial < 12; ++trial) {
    const int k = random.pick(1, 60), l = random.pick(1, 60);
    const auto functions = far_apart(
        fmt::format("1 + sin({}*pi*x)*sin({}*pi*y)", k, l), fmt::format("{0}*pi*cos({0}*pi*x)*sin({1}*pi*y)", k, l),
        fmt::format("{1}*pi*sin({0}*pi*x)*cos({1}*pi*y)", k, l), fmt::format("pi^2*{}*sin({}*pi*x)*sin({}*pi*y)", k * k + l * l, k, l));
    auto with_data = functions;
    with_data["data/g1"] = "1";
    const Judged seen = judged(scene_of("membranes", with_data, by("fem", 1 + trial % 3)));
    EXPECT_EQ(seen.promise, Promise::up_to_quadrature);
    record.add(seen, fmt::format("waves {}, {}", k, l));
  }
}

/// Polynomials as well, where the rule is too weak for them.
TEST(Promise, of_a_force_of_high_degree_takes_a_rule_that_integrates_it) {
  Random random(4);
  Record record;
  const auto functions = far_apart(Polynomial(12, random));
  for (const int order : {0, 19, 20}) {
    auto method = by("fem", 1);
    method.quadrature_order = order;
    const Judged seen = judged(scene_of("membranes", functions, method));
    EXPECT_EQ(seen.promise == Promise::guaranteed, order == 20) << order;
    record.add(seen, fmt::format("order {}", order));
  }
}

namespace {

/// As far from zero as 1 but at the points of a rule.
scene::FieldPtr unseen(const std::vector<double>& x, const std::vector<double>& y) {
  return scene::formula([x, y](double at_x, double at_y) {
    double nearest = 1;
    for (std::size_t q = 0; q < x.size(); ++q) nearest = std::min(nearest, std::hypot(at_x - x[q], at_y - y[q]));
    return 64 * std::min(1.0, nearest / 1e-4);
  });
}

}  // namespace

/// The discrete solution is 0, and so is the number that stands for the bound; the error is at least (f, v)/|||v||| for any v.
TEST(Promise, of_a_force_that_vanishes_at_all_points_of_the_rule_is_none) {
  const auto method = by("fem", 2);
  const auto params = scene_of("membranes", {{"data/g1", "0"}, {"data/g2", "-9"}}, method);
  mesh::Hierarchy hierarchy = mesh::build(params.mesh, core::Comm(), ".");
  const auto quadrature = method::make_quadrature(hierarchy.finest(), method::owned_cells(hierarchy.finest()), method.order(), nullptr);
  std::vector<double> x, y;
  method::for_each_block(quadrature, [&](const method::QuadratureBlock& block) {
    x.insert(x.end(), block.x.data(), block.x.data() + block.points);
    y.insert(y.end(), block.y.data(), block.y.data() + block.points);
  });
  membranes::MembraneScene scene = membranes::membrane_scene(params.scene);
  scene.force[0] = unseen(x, y);
  const auto model = membranes::membranes(scene, method_of(method.name), method, params.linear, {});
  const auto outcome = drive::solve_stationary(*model, hierarchy, params, {});
  EXPECT_EQ(outcome.estimate->promise, Promise::up_to_quadrature);

  constexpr int n = 100;
  std::vector<double> at_x, at_y, f(n * n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) at_x.push_back((i + 0.5) / n), at_y.push_back((j + 0.5) / n);
  scene.force[0]->evaluate({at_x.size(), at_x.data(), at_y.data()}, 0, f.data());
  double work = 0;
  for (int k = 0; k < n * n; ++k) work += f[k] * at_x[k] * (1 - at_x[k]) * at_y[k] * (1 - at_y[k]) / (n * n);
  const double energy = std::sqrt(2.0 / 90);  // of v = x (1 - x) y (1 - y)
  EXPECT_LT(outcome.estimate->total, 0.1 * work / energy) << "otherwise this says nothing";
}

TEST(Promise, of_boundary_data_that_no_face_resolves_is_none) {
  Record record;
  for (const double k : {3.0, 17.0, 90.0, 804.25})  // the last one: near 64 waves on a face of length 1/4, what 64 pieces do not see
    for (int p = 1; p <= 2; ++p) {
      const auto functions =
          far_apart(fmt::format("2 + exp({0}*(y - 1))*cos({0}*x)", k), fmt::format("-{0}*exp({0}*(y - 1))*sin({0}*x)", k),
                    fmt::format("{0}*exp({0}*(y - 1))*cos({0}*x)", k), "0");
      const Judged seen = judged(scene_of("membranes", functions, by("fem", p)));
      EXPECT_EQ(seen.promise, Promise::up_to_quadrature) << k;
      record.add(seen, fmt::format("wave number {} on the boundary", k));
    }
}

TEST(Promise, of_tractions_that_no_face_resolves_is_none) {
  Record record;
  for (const int k : {1, 7, 40, 200}) {
    auto functions = far_apart(fmt::format("2 + exp({0}*(y - 1))*sin({0}*pi*x/pi)", k), fmt::format("{0}*exp({0}*(y - 1))*cos({0}*x)", k),
                               fmt::format("{0}*exp({0}*(y - 1))*sin({0}*x)", k), "0");
    auto params = scene_of("membranes", functions, by("fem", 1));
    membranes::of(params.scene).boundary["top"].kind = membranes::BoundaryKind::neumann;
    membranes::of(params.scene).boundary["top"].t1.text = fmt::format("{0}*sin({0}*x)", k);
    const Judged seen = judged(params);
    EXPECT_EQ(seen.promise, Promise::up_to_quadrature) << k;
    record.add(seen, fmt::format("traction of wave number {}", k));
  }
}

/// A roof whose ridge no face follows, with the membrane on it.
TEST(Promise, of_a_kinked_obstacle_without_an_interface_is_none) {
  Random random(5);
  Record record;
  for (int trial = 0; trial < 6; ++trial) {
    const double ridge = random(0.2, 0.8);
    const std::string roof = fmt::format("1 - abs(x - {:.17g})", ridge);
    for (const bool named : {false, true}) {
      Functions functions = {{"data/psi", roof},
                             {"data/u", roof},
                             {"data/u_x", fmt::format("x < {:.17g} ? 1 : -1", ridge)},
                             {"data/u_y", "0"},
                             {"data/g", roof}};
      if (named) functions["interface"] = fmt::format("x - {:.17g}", ridge);
      const Judged seen = judged(scene_of("obstacle", functions, by("fem", 1 + trial % 2)), fmt::format("x - {:.17g}", ridge));
      EXPECT_EQ(seen.promise, Promise::up_to_quadrature) << ridge;
      record.add(seen, roof);
    }
  }
}

/// A step inside of cells, along an interface, and along faces: its upper height counts on the edge, which no interpolant has.
TEST(Promise, of_an_obstacle_that_jumps_is_none) {
  for (int p = 1; p <= 2; ++p)
    for (const auto& [name, method] : methods(p))
      for (const char* edge : {"0.31", "0.5"})
        for (const bool known : {false, true}) {
          Functions functions = {{"data/psi", fmt::format("x < {} ? 0.2 : -0.4", edge)}, {"data/f", "-1"}, {"data/g", "0.3"}};
          if (known) {
            functions["interface"] = fmt::format("x - {}", edge);
            functions["data/degree"] = "1";
          }
          const Solved run = solve(scene_of("obstacle", functions, method));
          EXPECT_TRUE(run.outcome.solved) << name << ", " << edge;
          EXPECT_EQ(run.outcome.estimate->promise, Promise::up_to_quadrature) << name << ", " << edge << (known ? ", named" : "");
        }
}

TEST(Promise, of_pieces_that_meet_at_faces_is_guaranteed_when_the_deck_names_their_degree) {
  for (int p = 1; p <= 2; ++p) {
    Functions functions = {{"data/psi", "1 - abs(x - 0.5)"},
                           {"data/g", "1 - abs(x - 0.5)"},
                           {"data/f", "x < 0.5 ? -1 : -y"},
                           {"data/mu", "y < 0.5 ? 1 : 1e4"}};
    EXPECT_EQ(solve(scene_of("obstacle", functions, by("fem", p))).outcome.estimate->promise, Promise::up_to_quadrature);
    functions["data/degree"] = "1";
    const Solved run = solve(scene_of("obstacle", functions, by("fem", p)));
    EXPECT_TRUE(run.outcome.solved);
    EXPECT_EQ(run.outcome.estimate->promise, Promise::guaranteed);
  }
}

/// (1 - (x - 0.47)²)^(2^36) is 1 on a line and 0 elsewhere: a degree that no integer of 32 bits holds.
TEST(Promise, of_powers_of_powers_is_none) {
  const auto tower = [](const std::string& text) { return "((((((" + text + ")^64)^64)^64)^64)^64)^64"; };
  for (const Functions& functions :
       {Functions{{"data/f", "-8 - 1e7*" + tower("1 - (x - 0.47)^2")}, {"data/psi", "0"}},
        Functions{{"data/f", "-8*" + tower("1 - 1e-10*x")}, {"data/psi", "0"}},
        Functions{{"data/mu", "1 + " + tower("1 - 1e-10*x")}, {"data/psi", "0"}},
        Functions{{"data/f", "-8/" + tower("1 - 1e-10*x")}, {"data/psi", "0"}}, Functions{{"data/psi", "-" + tower("1 - (x - 0.47)^2")}}}) {
    auto held = functions;
    held["data/g"] = "0.1";
    const Solved run = solve(scene_of("obstacle", held, by("fem", 1)));
    EXPECT_TRUE(run.outcome.solved);
    EXPECT_EQ(run.outcome.estimate->promise, Promise::up_to_quadrature) << functions.begin()->second;
  }
}

/// A disk between the points at which the level set is looked at: no cell counts as cut, and all that is seen of the data is one constant.
TEST(Promise, of_pieces_along_an_interface_is_none_though_no_cell_is_seen_to_be_cut) {
  const Functions disk = {{"data/g", "0.1"}, {"data/psi", "0"}, {"data/centre", "{0.43,0.47}"}, {"data/degree", "0"}};
  for (const auto& [name, text] : std::map<std::string, std::string>{{"f", "r < 0.01 ? -80000 : -8"}, {"mu", "r < 0.01 ? 1e6 : 1"}}) {
    auto functions = disk;
    functions["data/" + name] = text;
    functions["interface"] = "r - 0.01";
    EXPECT_EQ(solve(scene_of("obstacle", functions, by("fem", 1))).outcome.estimate->promise, Promise::up_to_quadrature) << name;
  }
}

/// Of data that are one polynomial each a curve takes nothing, wherever it lies; of pieces it does so even where it follows faces.
TEST(Promise, of_whole_polynomials_does_not_depend_on_the_interface) {
  Random random(6);
  const auto whole = far_apart(Polynomial(3, random));
  for (const char* interface : {"r - 0.3", "r - 0.001", "x - 0.5"}) {
    auto functions = whole;
    functions["interface"] = interface;
    EXPECT_EQ(judged(scene_of("membranes", functions, by("fem", 1))).promise, Promise::guaranteed) << interface;
    functions["data/f2"] = "x < 0.5 ? -1 : -y";
    functions["data/degree"] = "1";
    EXPECT_EQ(judged(scene_of("membranes", functions, by("fem", 1))).promise, Promise::up_to_quadrature) << interface;
  }
}

TEST(Promise, a_degree_that_the_data_visibly_do_not_have_is_refused) {
  for (const auto& [what, functions] :
       std::map<std::string, Functions>{{"f", {{"data/f", "sin(9*x)"}, {"data/g", "2"}, {"data/psi", "0"}}},
                                        {"psi", {{"data/psi", "-abs(x - 0.37)"}, {"data/g", "2"}}},
                                        {"mu", {{"data/mu", "x < 0.3 ? 1 : 2"}, {"data/g", "2"}, {"data/psi", "0"}}},
                                        {"g", {{"data/g", "2 + abs(x - 0.37)"}, {"data/psi", "0"}}}}) {
    auto with_degree = functions;
    with_degree["data/degree"] = "1";
    try {
      solve(scene_of("obstacle", with_degree, by("fem", 1)));
      ADD_FAILURE() << what;
    } catch (const core::InputError& error) {
      EXPECT_EQ(std::string(error.what()).find("scene/data/degree: " + what + " is no polynomial of degree"), 0u) << error.what();
    }
  }
}

}  // namespace thixis::verification
