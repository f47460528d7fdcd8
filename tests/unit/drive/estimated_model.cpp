#include "estimated_model.hpp"

#include <algorithm>
#include <cmath>

#include "registry.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/fem/entry.hpp"
#include "thixis/membranes/membranes.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::drive::test {
namespace {

class Estimated final : public models::Discretization {
 public:
  Estimated(const EstimatedModel& model, std::unique_ptr<models::Discretization> inner, const mesh::Mesh& mesh, double effectivity)
      : model_(model), inner_(std::move(inner)), mesh_(mesh), effectivity_(effectivity) {}

  complementarity::Problem& problem() override { return inner_->problem(); }
  const core::Comm& comm() const override { return mesh_.comm; }
  GlobalIndex cells() const override { return mesh_.global_cells; }
  models::Sizes sizes() const override { return inner_->sizes(); }
  int sweeps() const override { return inner_->sweeps(); }
  Teuchos::RCP<algebra::Vector> cold_start() const override {
    model_.nested.push_back(false);
    return inner_->cold_start();
  }
  Teuchos::RCP<algebra::Vector> nested_start(const models::Discretization& coarse, const algebra::Vector& X) const override {
    model_.nested.push_back(true);
    return inner_->nested_start(*dynamic_cast<const Estimated&>(coarse).inner_, X);
  }
  models::State save(const algebra::Vector& X) const override { return inner_->save(X); }
  Teuchos::RCP<algebra::Vector> restore(const output::StoredCheckpoint& stored) override { return inner_->restore(stored); }
  std::optional<double> energy_error(const algebra::Vector& X) const override { return inner_->energy_error(X); }
  double energy_norm(const algebra::Vector& X) const override { return inner_->energy_norm(X); }

  complementarity::Estimate estimate(const algebra::Vector& X) override {
    ++model_.estimates;
    algebra::Vector R(inner_->problem().map()), K(inner_->problem().points()), G(inner_->problem().points());
    inner_->problem().equations(X, R);
    inner_->problem().arguments(X, K, G);
    double below[2] = {0, 0};
    for (const double gap : K.getData()) below[0] += std::max(-gap, 0.0);
    for (const double lambda : G.getData()) below[1] += std::max(-lambda, 0.0);
    complementarity::Estimate eta;
    eta.discretization = effectivity_ * *inner_->energy_error(X);
    eta.algebraic = R.norm2();
    eta.linearization = mesh_.comm.sum(below[0]) + 1e-2 * mesh_.comm.sum(below[1]);
    eta.total = eta.discretization + eta.linearization + eta.algebraic;
    eta.promise = model_.promise;
    cells_ = shared_out(eta);
    return eta;
  }
  models::CellEstimates cell_estimates() const override { return cells_; }
  std::optional<models::PublishedEstimate> published_estimate(const algebra::Vector& X, std::optional<double>) override {
    models::PublishedEstimate published;
    published.parts.total = published.parts.discretization = 10 * *inner_->energy_error(X);
    published.terms = {{"residual", published.parts.total}};
    return published;
  }
  complementarity::KktData kkt_data(const algebra::Vector& X) const override { return inner_->kkt_data(X); }
  models::Rounding rounding(const algebra::Vector& X) const override { return inner_->rounding(X); }
  std::optional<models::Contact> contact(const algebra::Vector& X) const override { return inner_->contact(X); }
  std::vector<double> values_at(const std::vector<models::Probe>& probes, const algebra::Vector& X) const override {
    return inner_->values_at(probes, X);
  }
  output::Grid grid() const override { return inner_->grid(); }
  std::vector<output::FieldData> fields(const algebra::Vector& X, const complementarity::ActiveSet& active,
                                        const std::vector<std::string>& names) const override {
    return inner_->fields(X, active, names);
  }

 private:
  models::CellEstimates shared_out(const complementarity::Estimate& eta) const {
    const mesh::HostMesh host = mesh::on_host(mesh_);
    std::vector<double> weight(mesh_.owned_cells);
    double sum = 0;
    for (LocalIndex K = 0; K < mesh_.owned_cells; ++K) {
      const auto at = [&](int vertex, int d) { return host.coordinates(host.cell_vertices(K, vertex), d); };
      const double x = (at(0, 0) + at(1, 0) + at(2, 0)) / 3, y = (at(0, 1) + at(1, 1) + at(2, 1)) / 3;
      const double area = 0.5 * ((at(1, 0) - at(0, 0)) * (at(2, 1) - at(0, 1)) - (at(2, 0) - at(0, 0)) * (at(1, 1) - at(0, 1)));
      sum += weight[K] = area * area * (1 + 50 * std::exp(-50 * std::pow(std::hypot(x - 0.5, y - 0.5) - 1.0 / 3, 2)));
    }
    sum = mesh_.comm.sum(sum);
    models::CellEstimates cells;
    for (const double w : weight) {
      const double part = std::sqrt(w / sum);
      cells.discretization.push_back(part * eta.discretization);
      cells.linearization.push_back(part * eta.linearization);
      cells.algebraic.push_back(part * eta.algebraic);
    }
    return cells;
  }

  const EstimatedModel& model_;
  std::unique_ptr<models::Discretization> inner_;
  const mesh::Mesh& mesh_;
  double effectivity_;
  models::CellEstimates cells_;
};

}  // namespace

EstimatedModel::EstimatedModel(const RunParams& params)
    : inner_(membranes::membranes(membranes::membrane_scene(params.scene), fem::entry(), params.method, params.linear, {})) {}

std::unique_ptr<models::Discretization> EstimatedModel::discretize(const mesh::Hierarchy& hierarchy, int level) const {
  entered.push_back(level);
  return std::make_unique<Estimated>(*this, inner_->discretize(hierarchy, level), hierarchy.levels[level],
                                     (level > good_levels ? 10 : 1) * effectivity);
}

RunParams smooth_contact() {
  RunParams params = catalogue().defaults();
  params.scene.case_name = "smooth contact";
  params.mesh.cells_per_side = 4;
  params.mesh.refinements = 1;
  params.mesh.cells_per_rank = 20;
  params.linear.form = algebra::SystemForm::reduced;
  params.linear.solver = algebra::SolverKind::direct;
  return params;
}

}  // namespace thixis::drive::test
