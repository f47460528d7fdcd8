#pragma once
#include <locale>

#include "thixis/core/deck.hpp"
#include "thixis/core/expression.hpp"

/// A deck with one of everything.
namespace thixis::core::test {

enum class CFunction { min, fischer_burmeister };
enum class Model { membranes, obstacle };

struct InitialParams {
  Formula u1, u2{"0"};
  static const Schema<InitialParams>& schema() {
    static const auto s = Schema<InitialParams>("initial", "Where Newton starts.")
                              .parameter("u1", &InitialParams::u1, "Upper membrane.")
                              .parameter("u2", &InitialParams::u2, "Lower membrane.");
    return s;
  }
};
inline bool operator==(const InitialParams& a, const InitialParams& b) { return a.u1 == b.u1 && a.u2 == b.u2; }

struct NewtonParams {
  int max_iterations = 50;
  double damping = 1.0;
  bool nested = false;
  CFunction c_function = CFunction::min;
  std::optional<double> target;
  InitialParams initial;
  static const Schema<NewtonParams>& schema() {
    static const auto s =
        Schema<NewtonParams>("newton", "How the nonlinear system is solved.")
            .parameter("max iterations", &NewtonParams::max_iterations, at_least(0), "Newton steps after which the run ends unconverged.")
            .parameter("damping", &NewtonParams::damping, strictly_between(0, 2), "Factor of the step.")
            .parameter("nested", &NewtonParams::nested, "Whether to start from the coarser mesh.")
            .choice("c-function", &NewtonParams::c_function,
                    {{"min", CFunction::min}, {"fischer-burmeister", CFunction::fischer_burmeister}}, "Function of the contact conditions.")
            .parameter("target", &NewtonParams::target, above(0), "Residual to reach.")
            .block("initial", &NewtonParams::initial, InitialParams::schema());
    return s;
  }
};

struct LinearParams {
  int restart = 30;
  double tolerance = 1e-8;
  long long max_iterations = 3000000000LL;
  std::string preconditioner = "ilu";
  static const Schema<LinearParams>& schema() {
    static const auto s =
        Schema<LinearParams>("linear", "How a linear system is solved.")
            .parameter("restart", &LinearParams::restart, at_least(1), "Krylov vectors kept.")
            .parameter("tolerance", &LinearParams::tolerance, at_least(0), "Relative residual.")
            .parameter("max iterations", &LinearParams::max_iterations, at_least(0), "Iterations at most.")
            .parameter("preconditioner", &LinearParams::preconditioner, one_of({"none", "ilu", "muelu"}), "Of the system.");
    return s;
  }
};

struct BoundaryParams {
  std::string kind = "dirichlet";
  Formula value{"0"};
  static const Schema<BoundaryParams>& schema() {
    static const auto s = Schema<BoundaryParams>("boundary", "Condition on one part of the boundary.")
                              .parameter("kind", &BoundaryParams::kind, one_of({"dirichlet", "neumann"}), "Type of the condition.")
                              .parameter("value", &BoundaryParams::value, "Its data.");
    return s;
  }
};
inline bool operator==(const BoundaryParams& a, const BoundaryParams& b) { return a.kind == b.kind && a.value == b.value; }

struct SceneParams {
  Model model = Model::membranes;
  std::map<std::string, double> constants;
  std::map<std::string, BoundaryParams> boundary;
  std::optional<Formula> interface;
  static const Schema<SceneParams>& schema() {
    static const auto s =
        Schema<SceneParams>("scene", "What is solved.")
            .choice("model", &SceneParams::model, {{"membranes", Model::membranes}, {"obstacle", Model::obstacle}}, "The equations.")
            .required()
            .parameter("interface", &SceneParams::interface, "Where data jump.")
            .values("constants", &SceneParams::constants, "Names for use in expressions.")
            .blocks("boundary", &SceneParams::boundary, BoundaryParams::schema(), "One list for each tag.")
            .check([](const SceneParams& p, Problems& problems) {
              for (const auto& [tag, b] : p.boundary) try {
                  Expression(b.value.text, {"x", "y"}, p.constants);
                } catch (const InputError& error) {
                  problems.add("boundary/" + tag + "/value", error.what());
                }
            });
    return s;
  }
};

struct MeshParams {
  std::vector<double> lower{0, 0};
  std::vector<int> cells{4};
  std::vector<std::string> tags;
  static const Schema<MeshParams>& schema() {
    static const auto s = Schema<MeshParams>("mesh", "Cells.")
                              .parameter("lower", &MeshParams::lower, entries(2), "Lower left corner.")
                              .parameter("cells", &MeshParams::cells, at_least(1).entries(1, 2), "Cells along each axis.")
                              .parameter("tags", &MeshParams::tags, "Names of the sides.");
    return s;
  }
};

struct TimeParams {
  double end = 1;
  static const Schema<TimeParams>& schema() {
    static const auto s = Schema<TimeParams>("time", "Time steps.").parameter("end", &TimeParams::end, above(0), "Last time.").required();
    return s;
  }
};

struct RunParams {
  SceneParams scene;
  MeshParams mesh;
  NewtonParams newton;
  LinearParams linear;
  std::optional<TimeParams> time;
  static const Schema<RunParams>& schema() {
    static const auto s = Schema<RunParams>("thixis", "A run.")
                              .block("scene", &RunParams::scene, SceneParams::schema())
                              .block("mesh", &RunParams::mesh, MeshParams::schema())
                              .block("newton", &RunParams::newton, NewtonParams::schema())
                              .block("linear", &RunParams::linear, LinearParams::schema())
                              .block("time", &RunParams::time, TimeParams::schema());
    return s;
  }
};

inline RunParams parse(const std::string& text) { return Deck::from_text(text, "x.xml").parse(RunParams::schema()); }

/// The deck `inside` of the outermost list, with the required model on line 2.
inline std::string deck_with(const std::string& inside) {
  return "<ParameterList name=\"thixis\">\n"
         "<ParameterList name=\"scene\"><Parameter name=\"model\" type=\"string\" value=\"obstacle\"/></ParameterList>\n" +
         inside + "</ParameterList>\n";
}

/// What the deck's InputError says; "" if there is none.
template <class F>
std::string input_error(F f) {
  try {
    f();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}
inline std::string error_of(const std::string& text) {
  return input_error([&] { parse(text); });
}
inline std::string error_in(const std::string& inside) { return error_of(deck_with(inside)); }

/// While it lives, the locale writes 1.234,5.
class WithDecimalComma {
 public:
  WithDecimalComma() : before_(std::locale::global(std::locale(std::locale::classic(), new Comma))) {}
  ~WithDecimalComma() { std::locale::global(before_); }
  WithDecimalComma(const WithDecimalComma&) = delete;
  WithDecimalComma& operator=(const WithDecimalComma&) = delete;

 private:
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  std::locale before_;
};

}  // namespace thixis::core::test
