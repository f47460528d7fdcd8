#include "thixis/models/membranes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "membrane_checks.hpp"
#include "membrane_problem.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/timer.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::models {
namespace {

using algebra::MultiVector;
using algebra::Vector;
using method::Coefficients;

const char* const unknown_fields[] = {"u1", "u2", "lambda"};

void check_size(const output::StoredCheckpoint& stored, const std::string& block, GlobalIndex unknowns) {
  const GlobalIndex saved = stored.size(block);
  if (saved == unknowns) return;
  throw core::InputError(
      fmt::format("The checkpoint '{}' belongs to another model, mesh or method: it holds {}, the deck asks for {}; leave scene/model, "
                  "mesh, method and the kinds of the boundary as they were.",
                  stored.path(), saved < 0 ? fmt::format("no '{}'", block) : fmt::format("{} values of '{}'", saved, block), unknowns));
}

/// Diagonal of the box around the mesh. Collective.
double diameter(const mesh::Mesh& mesh) {
  const auto x = mesh::on_host(mesh).coordinates;
  double box[4] = {-1e300, -1e300, -1e300, -1e300};  // -lower, upper
  for (LocalIndex v = 0; v < mesh.vertices; ++v)
    for (int d = 0; d < 2; ++d) {
      box[d] = std::max(box[d], -x(v, d));
      box[2 + d] = std::max(box[2 + d], x(v, d));
    }
  for (double& side : box) side = mesh.comm.max(side);
  return std::hypot(box[2] + box[0], box[3] + box[1]);
}

/// Largest absolute value. Collective.
double largest(const Coefficients& u, const core::Comm& comm) {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), u);
  double value = 0;
  for (std::size_t i = 0; i < host.extent(0); ++i) value = std::max(value, std::abs(host(i)));
  return comm.max(value);
}

class MembraneDiscretization final : public Discretization {
 public:
  MembraneDiscretization(const scene::MembraneScene& scene, const method::SpaceFactory& make_space, const method::MethodParams& method,
                         const algebra::LinearParams& linear, const std::array<scene::FieldPtr, 3>& initial, const mesh::Mesh& mesh)
      : scene_(scene), initial_(initial), boundary_(boundary_of(scene, mesh)) {
    const core::Region region("assembly");
    space_ = make_space(mesh, {boundary_.dirichlet, scene.interface_level_set, method});
    for (int alpha = 0; alpha < 2; ++alpha) {
      lift_[alpha] = space_->lift(boundary_.values[alpha], 0);
      body_[alpha] = Teuchos::rcp(new Vector(space_->map()));
      space_->load(*scene_.force[alpha], boundary_.values[alpha], 0, *body_[alpha]);
    }
    problem_ = std::make_unique<MembraneProblem>(make_operator(), linear, space_->coordinates());
  }

  complementarity::Problem& problem() override { return *problem_; }

  Sizes sizes() const override {
    return {3 * static_cast<GlobalIndex>(space_->map()->getGlobalNumElements()), problem_->rows(), problem_->nonzeros()};
  }

  Teuchos::RCP<Vector> cold_start() const override {
    MultiVector x(space_->map(), 3);
    for (int field = 0; field < 3; ++field)
      if (initial_[field]) space_->interpolate(*initial_[field], 0, *x.getVectorNonConst(field));
    return joined(x);
  }

  Teuchos::RCP<Vector> nested_start(const Discretization& coarse_level, const Vector& coarse_X) const override {
    const auto& coarse = dynamic_cast<const MembraneDiscretization&>(coarse_level);
    MultiVector coarse_x(coarse.space_->map(), 3), x(space_->map(), 3);
    split(coarse_X, coarse_x);
    coarse.problem_->settle(coarse_x);
    for (int field = 0; field < 3; ++field) {
      const auto u = coarse.space_->complete(*coarse_x.getVector(field), field < 2 ? coarse.lift_[field] : coarse.nothing());
      space_->prolongate(*coarse.space_, u, *x.getVectorNonConst(field));
    }
    problem_->make_complementary(x);
    return joined(x);
  }

  std::vector<output::CheckpointBlock> save(const Vector& X) const override {
    MultiVector x(space_->map(), 3);
    split(X, x);
    const auto ids = space_->unknown_ids();
    std::vector<output::CheckpointBlock> blocks;
    for (int field = 0; field < 3; ++field) {
      const auto column = x.getVector(field);
      const auto values = algebra::host_view(*column);
      blocks.push_back({unknown_fields[field], ids, {values.data(), values.data() + values.extent(0)}});
    }
    return blocks;
  }

  Teuchos::RCP<Vector> restore(const output::StoredCheckpoint& stored) const override {
    const auto unknowns = static_cast<GlobalIndex>(space_->map()->getGlobalNumElements());
    const auto ids = space_->unknown_ids();
    MultiVector x(space_->map(), 3);
    for (int field = 0; field < 3; ++field) {
      check_size(stored, unknown_fields[field], unknowns);
      const auto values = stored.fetch(unknown_fields[field], ids);
      const auto column = x.getVectorNonConst(field);
      const auto out = algebra::host_overwrite(*column);
      std::copy(values.begin(), values.end(), out.data());
    }
    return joined(x);
  }

  std::optional<double> energy_error(const Vector& X) const override {
    if (!scene_.exact) return std::nullopt;
    double sum = 0;
    for (int alpha = 0; alpha < 2; ++alpha)
      sum += space_->energy_error(*scene_.tension[alpha], membrane(X, alpha), scene_.exact->gradient[alpha], 0);
    return std::sqrt(sum);
  }

  double energy_norm(const Vector& X) const override {
    double sum = 0;
    for (int alpha = 0; alpha < 2; ++alpha) sum += space_->energy(*scene_.tension[alpha], membrane(X, alpha));
    return std::sqrt(sum);
  }

  complementarity::KktData kkt_data(const Vector& X) const override {
    complementarity::KktData data;
    MultiVector x(space_->map(), 3);
    split(X, x);
    auto gap = Teuchos::rcp(new Vector(space_->map()));
    gap->update(1, *x.getVector(0), -1, *x.getVector(1), 0);
    data.gap = gap;
    data.claimed = Teuchos::rcp(new Vector(*x.getVector(2), Teuchos::Copy));
    Vector inverse(space_->map());
    inverse.reciprocal(space_->pairing());
    const double width = diameter(space_->mesh());
    double size = 0;
    data.multiplier_scale = 0;
    for (int alpha = 0; alpha < 2; ++alpha) {
      // lambda_1 = (a(u1, psi) - F1) / D,  lambda_2 = (F2 - a(u2, psi)) / D
      Vector defect(space_->map());
      space_->forces(*scene_.tension[alpha], membrane(X, alpha), defect);
      const double sign = alpha == 0 ? 1 : -1;
      defect.update(-sign, *body_[alpha], sign);
      auto multiplier = Teuchos::rcp(new Vector(space_->map()));
      multiplier->elementWiseMultiply(1, inverse, defect, 0);
      data.equilibrium.push_back(multiplier);
      // what is large: the force per area that is there, and the one that bends the membrane over the width of the domain
      const double height = std::max(x.getVector(alpha)->normInf(), largest(lift_[alpha], space_->mesh().comm));
      defect.elementWiseMultiply(1, inverse, *body_[alpha], 0);
      data.multiplier_scale = std::max(
          {data.multiplier_scale, multiplier->normInf(), defect.normInf(), problem_->mean_tension(alpha) * height / (width * width)});
      size = std::max(size, height);
    }
    data.smallest_pairing = 1 / inverse.normInf();
    if (!(data.multiplier_scale > 0)) data.multiplier_scale = 1;
    // ... and a gap: the heights that are there, and what such a force opens at one point
    Vector s(space_->map());
    problem_->scaling(s);
    data.gap_scale = std::max(size, s.normInf() * data.multiplier_scale);
    if (!(data.gap_scale > 0)) data.gap_scale = 1;
    return data;
  }

  std::vector<output::FieldData> fields(const Vector& X, const complementarity::ActiveSet& active,
                                        const std::vector<std::string>& names) const override {
    std::vector<output::FieldData> fields;
    const auto add = [&](const char* name, auto values) {
      if (names.empty() || std::find(names.begin(), names.end(), name) != names.end())
        fields.push_back({name, output::Centre::vertex, values()});
    };
    MultiVector x(space_->map(), 3);
    split(X, x);
    const auto difference = [&] {
      auto gap = space_->at_vertices(membrane(X, 0));
      const auto lower = space_->at_vertices(membrane(X, 1));
      for (std::size_t v = 0; v < gap.size(); ++v) gap[v] -= lower[v];
      return gap;
    };
    const auto flags = [&] {
      Vector flag(space_->map());
      const auto out = algebra::host_overwrite(flag);
      for (std::size_t l = 0; l < active.flags().size(); ++l) out(l) = active.flags()[l];
      return flag;
    };
    add("u1", [&] { return space_->at_vertices(membrane(X, 0)); });
    add("u2", [&] { return space_->at_vertices(membrane(X, 1)); });
    add("lambda", [&] { return space_->at_vertices(space_->complete(*x.getVector(2), nothing())); });
    add("gap", difference);
    add("active", [&] { return space_->at_vertices(space_->complete(flags(), nothing())); });
    return fields;
  }

 private:
  MembraneOperator make_operator() const {
    MembraneOperator membranes;
    membranes.pairing = Teuchos::rcpFromRef(space_->pairing());
    const double* constant[2] = {scene_.tension[0]->constant(), scene_.tension[1]->constant()};
    if (constant[0] && constant[1]) {
      membranes.matrix[0] = membranes.matrix[1] = space_->stiffness(*scene::constant(1));
      membranes.factor = {*constant[0], *constant[1]};
    } else {
      for (int alpha = 0; alpha < 2; ++alpha) membranes.matrix[alpha] = space_->stiffness(*scene_.tension[alpha]);
    }
    for (int alpha = 0; alpha < 2; ++alpha) {
      // what the Dirichlet data exert on the unknowns moves to the right
      Vector held(space_->map());
      space_->forces(*scene_.tension[alpha], lift_[alpha], held);
      membranes.load[alpha] = Teuchos::rcp(new Vector(*body_[alpha], Teuchos::Copy));
      membranes.load[alpha]->update(-1, held, 1);
      Vector diagonal(space_->map());
      membranes.matrix[alpha]->getLocalDiagCopy(diagonal);
      membranes.tension[alpha] = membranes.factor[alpha] * diagonal.meanValue();
    }
    if (space_->map()->getGlobalNumElements() > 0)
      for (int alpha = 0; alpha < 2; ++alpha)
        membranes.theta[alpha] = membranes.tension[alpha] / (membranes.tension[0] + membranes.tension[1]);
    return membranes;
  }

  Coefficients membrane(const Vector& X, int alpha) const {
    MultiVector x(space_->map(), 3);
    split(X, x);
    return space_->complete(*x.getVector(alpha), lift_[alpha]);
  }
  /// The multiplier has no boundary values.
  Coefficients nothing() const { return Coefficients("thixis::models::nothing", lift_[0].extent(0)); }

  Teuchos::RCP<Vector> joined(const MultiVector& x) const {
    auto X = Teuchos::rcp(new Vector(problem_->map()));
    join(x, *X);
    return X;
  }

  const scene::MembraneScene& scene_;
  const std::array<scene::FieldPtr, 3>& initial_;
  Boundary boundary_;
  std::unique_ptr<method::Space> space_;
  Coefficients lift_[2];
  Teuchos::RCP<Vector> body_[2];  ///< (f_alpha, psi_l) + Neumann data
  std::unique_ptr<MembraneProblem> problem_;
};

class Membranes final : public Model {
 public:
  Membranes(scene::MembraneScene scene, method::SpaceFactory make_space, method::MethodParams method, algebra::LinearParams linear,
            std::array<scene::FieldPtr, 3> initial)
      : scene_(std::move(scene)), make_space_(std::move(make_space)), method_(method), linear_(linear), initial_(std::move(initial)) {
    for (int field = 0; field < 3; ++field)
      if (!initial_[field]) initial_[field] = scene_.initial[field];
  }
  std::string name() const override { return "membranes"; }
  std::string case_name() const override { return scene_.name == "data" ? "" : scene_.name; }
  void check(const mesh::Mesh& mesh, const std::vector<std::string>& field_names) const override {
    check_field_names(field_names);
    check_functions(scene_, initial_, method_, mesh);
  }
  std::unique_ptr<Discretization> discretize(const mesh::Mesh& mesh) const override {
    return std::make_unique<MembraneDiscretization>(scene_, make_space_, method_, linear_, initial_, mesh);
  }

 private:
  scene::MembraneScene scene_;
  method::SpaceFactory make_space_;
  method::MethodParams method_;
  algebra::LinearParams linear_;
  std::array<scene::FieldPtr, 3> initial_;
};

}  // namespace

std::unique_ptr<Model> membranes(scene::MembraneScene scene, method::SpaceFactory make_space, method::MethodParams method,
                                 algebra::LinearParams linear, std::array<scene::FieldPtr, 3> initial) {
  return std::make_unique<Membranes>(std::move(scene), std::move(make_space), method, linear, std::move(initial));
}

}  // namespace thixis::models
