#include "march.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "thixis/complementarity/kkt.hpp"
#include "thixis/complementarity/newton.hpp"

namespace thixis::verification {
int March::total() const { return std::accumulate(newton.begin(), newton.end(), 0); }

double March::at(std::size_t step, const std::string& column) const {
  const auto names = evolution->series_names();
  const auto found = std::find(names.begin(), names.end(), column);
  EXPECT_NE(found, names.end()) << column;
  return found == names.end() ? std::nan("") : series.at(step)[found - names.begin()];
}

double March::largest(const std::string& column) const {
  double value = 0;
  for (std::size_t n = 0; n < series.size(); ++n) value = std::max(value, at(n, column));
  return value;
}

double March::error_at_ends(double step) const {
  double sum = 0;
  for (std::size_t n = 0; n < series.size(); ++n) sum += step * std::pow(at(n, "energy_error"), 2);
  return std::sqrt(sum);
}

March march(const drive::RunParams& params, int steps, double end, const AtStep& at_step, const core::Comm& comm) {
  March run;
  run.model =
      membranes::parabolic_membranes(membranes::membrane_scene(params.scene), method_of(params.method.name), params.method, params.linear);
  run.evolution = run.model->evolve(params.mesh, comm, "", {});
  models::Evolution& evolution = *run.evolution;
  run.X = evolution.initial();
  for (int n = 1; n <= steps; ++n) {
    const algebra::Vector before(*run.X, Teuchos::Copy);
    evolution.begin({end * (n - 1) / steps, end * n / steps}, before);
    const auto report =
        complementarity::newton(evolution.problem(), *run.X, params.newton, params.stopping, params.linear.check_every, {}, {});
    EXPECT_TRUE(report.converged) << "step " << n << ": " << report.why;
    run.solved = run.solved && report.converged;
    evolution.accept(*run.X);
    run.newton.push_back(report.steps);
    run.series.push_back(evolution.series(*run.X));
    run.worst_kkt = std::max(run.worst_kkt, complementarity::verify(evolution.kkt_data(*run.X)).worst());
    if (at_step) at_step(evolution, end * n / steps, *run.X);
  }
  return run;
}

drive::RunParams on_squares(const std::string& name, int n, const std::string& method, int degree) {
  auto params = catalogue().defaults();
  params.scene.model = "parabolic membranes";
  params.scene.case_name = name;
  params.mesh.generator = mesh::Generator::rectangle;
  params.mesh.cells_per_side = n;
  params.method.name = method;
  params.method.degree = degree;
  params.newton.scaling = complementarity::Scaling::none;
  params.linear.solver = algebra::SolverKind::direct;
  params.stopping.linear_tolerance = 1e-12;
  params.stopping.nonlinear_tolerance = 1e-11;
  return params;
}

double order(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace thixis::verification
