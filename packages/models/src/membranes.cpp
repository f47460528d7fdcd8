#include "thixis/models/membranes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "membrane_problem.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/timer.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/method/quadrature.hpp"

namespace thixis::models {
namespace {

using algebra::MultiVector;
using algebra::Vector;
using method::BoundaryValues;
using method::Coefficients;

/// The scene's conditions in the order of the mesh's tags.
struct Boundary {
  std::vector<bool> dirichlet;
  BoundaryValues values[2];
};

Boundary boundary_of(const scene::MembraneScene& scene, const mesh::Mesh& mesh) {
  for (const auto& [tag, condition] : scene.boundary)
    if (std::find(mesh.tags.begin(), mesh.tags.end(), tag) == mesh.tags.end()) {
      std::string names;
      for (const auto& name : mesh.tags) names += (names.empty() ? "" : ", ") + name;
      throw core::InputError("scene/boundary/" + tag + ": the mesh has no such part of the boundary; write one of: " + names + ".");
    }
  Boundary boundary;
  for (const auto& tag : mesh.tags) {
    const auto given = scene.boundary.find(tag);
    const auto& condition = given == scene.boundary.end() ? scene.default_boundary : given->second;
    const bool dirichlet = condition.kind == scene::BoundaryKind::dirichlet;
    if (dirichlet && !(condition.value[0] && condition.value[1]))
      throw core::InputError(
          "scene/boundary/" + tag +
          ": nothing is said about this part of the boundary; give g1 and g2 there, or g1 and g2 in scene/data for all of it.");
    boundary.dirichlet.push_back(dirichlet);
    for (int alpha = 0; alpha < 2; ++alpha) {
      boundary.values[alpha].dirichlet.push_back(dirichlet ? condition.value[alpha] : nullptr);
      boundary.values[alpha].neumann.push_back(dirichlet ? nullptr : condition.value[alpha]);
    }
  }
  if (std::find(boundary.dirichlet.begin(), boundary.dirichlet.end(), true) == boundary.dirichlet.end())
    throw core::InputError(
        "scene/boundary: no part of the boundary has kind dirichlet, so the membranes are free to float away; fix at least one.");
  return boundary;
}

struct PointList {
  std::vector<double> x, y;
  void add(double px, double py) {
    x.push_back(px);
    y.push_back(py);
  }
  std::vector<double> evaluate(const scene::Field& field) const {
    std::vector<double> values(x.size());
    field.evaluate({x.size(), x.data(), y.data()}, 0, values.data());
    return values;
  }
};

/// Ends of the faces of a part of the boundary on this rank (ends: true), or their midpoints.
PointList points_on(const mesh::Mesh& mesh, const mesh::HostMesh& host, std::size_t tag, bool ends) {
  PointList points;
  for (LocalIndex F = 0; F < mesh.faces; ++F) {
    if (host.face_tag(F) != static_cast<LocalIndex>(tag)) continue;
    const LocalIndex a = host.face_vertices(F, 0), b = host.face_vertices(F, 1);
    const double ax = host.coordinates(a, 0), ay = host.coordinates(a, 1), bx = host.coordinates(b, 0), by = host.coordinates(b, 1);
    if (ends) points.add(ax, ay), points.add(bx, by);
    else points.add((ax + bx) / 2, (ay + by) / 2);
  }
  return points;
}

/// Throws where g1 < g2 at an end of a held face (membranes that cross at their boundary have no solution), and where boundary data are not
/// finite. Collective.
void check_boundary(const scene::MembraneScene& scene, const Boundary& boundary, const mesh::Mesh& mesh) {
  mesh.comm.together([&] {
    const auto host = mesh::on_host(mesh);
    for (std::size_t tag = 0; tag < boundary.dirichlet.size(); ++tag) {
      const PointList at = points_on(mesh, host, tag, boundary.dirichlet[tag]);
      if (!boundary.dirichlet[tag]) {
        for (const auto& values : boundary.values) at.evaluate(*values.neumann[tag]);
        continue;
      }
      const auto upper = at.evaluate(*boundary.values[0].dirichlet[tag]), lower = at.evaluate(*boundary.values[1].dirichlet[tag]);
      for (std::size_t i = 0; i < upper.size(); ++i)
        if (upper[i] < lower[i] - 1e-12 * (std::abs(upper[i]) + std::abs(lower[i])))
          throw core::InputError(
              fmt::format("{}: on the boundary '{}' the upper membrane lies below the lower one: g1 = {:.6g} < g2 = {:.6g} "
                          "at ({:.6g}, {:.6g}); give boundary data with g1 >= g2.",
                          scene.boundary.count(mesh.tags[tag]) > 0 ? "scene/boundary/" + mesh.tags[tag] : "scene/data/g1", mesh.tags[tag],
                          upper[i], lower[i], at.x[i], at.y[i]));
    }
  });
}

/// Throws where a tension is not positive or another function of the user is not finite: at the points where the run will ask for it, but
/// before anything is written. Collective.
void check_data(const scene::MembraneScene& scene, const method::MethodParams& method, const mesh::Mesh& mesh) {
  const auto quadrature = method::make_quadrature(mesh, method::owned_cells(mesh), method.order(), scene.interface_level_set);
  double lowest[2] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  mesh.comm.together([&] {
    const mesh::View<double*> values("thixis::models::data", quadrature.largest_block);
    const auto on_host = Kokkos::create_mirror_view(values);
    method::for_each_block(quadrature, [&](const method::QuadratureBlock& block) {
      for (int alpha = 0; alpha < 2; ++alpha) {
        method::evaluate(*scene.force[alpha], 0, block, values);
        if (scene.exact) method::evaluate(*scene.exact->u[alpha], 0, block, values);
        method::evaluate(*scene.tension[alpha], 0, block, values);
        Kokkos::deep_copy(on_host, values);
        for (int q = 0; q < block.points; ++q) lowest[alpha] = std::min(lowest[alpha], on_host(q));
      }
    });
  });
  for (int alpha = 0; alpha < 2; ++alpha)
    if (const double tension = mesh.comm.min(lowest[alpha]); !(tension > 0))
      throw core::InputError(
          fmt::format("scene/data/mu{}: the tension falls to {:.6g}; give one that is positive everywhere.", alpha + 1, tension));
}

/// Throws where the functions that a cold start begins with are not finite. Collective.
void check_initial(const std::array<scene::FieldPtr, 3>& initial, const mesh::Mesh& mesh) {
  mesh.comm.together([&] {
    PointList vertices;
    const auto coordinates = mesh::on_host(mesh).coordinates;
    for (LocalIndex v = 0; v < mesh.vertices; ++v) vertices.add(coordinates(v, 0), coordinates(v, 1));
    for (const auto& field : initial)
      if (field) vertices.evaluate(*field);
  });
}

const char* const known_fields[] = {"u1", "u2", "lambda", "gap", "active"};

void check_field_names(const std::vector<std::string>& names) {
  for (const auto& name : names)
    if (std::find(std::begin(known_fields), std::end(known_fields), name) == std::end(known_fields))
      throw core::InputError(
          fmt::format("output/fields: there is no field '{}'; write all, none, or some of {}.", name, fmt::join(known_fields, ", ")));
}

const char* const unknown_fields[] = {"u1", "u2", "lambda"};

void check_size(const output::StoredCheckpoint& stored, const std::string& block, GlobalIndex unknowns) {
  const GlobalIndex saved = stored.size(block);
  if (saved == unknowns) return;
  throw core::InputError(
      fmt::format("The checkpoint '{}' belongs to another model, mesh or method: it holds {}, the deck asks for {}; leave scene/model, "
                  "mesh, method and "
                  "the kinds of the boundary as they were.",
                  stored.path(), saved < 0 ? fmt::format("no '{}'", block) : fmt::format("{} values of '{}'", saved, block), unknowns));
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
    data.gap_scale = data.multiplier_scale = 0;
    for (int alpha = 0; alpha < 2; ++alpha) {
      // lambda_1 = (a(u1, psi) - F1) / D,  lambda_2 = (F2 - a(u2, psi)) / D
      Vector defect(space_->map());
      space_->forces(*scene_.tension[alpha], membrane(X, alpha), defect);
      const double sign = alpha == 0 ? 1 : -1;
      defect.update(-sign, *body_[alpha], sign);
      auto multiplier = Teuchos::rcp(new Vector(space_->map()));
      multiplier->elementWiseMultiply(1, inverse, defect, 0);
      data.equilibrium.push_back(multiplier);
      data.gap_scale = std::max(data.gap_scale, x.getVector(alpha)->normInf());
      defect.elementWiseMultiply(1, inverse, *body_[alpha], 0);
      data.multiplier_scale = std::max({data.multiplier_scale, multiplier->normInf(), defect.normInf()});
    }
    data.smallest_pairing = 1 / inverse.normInf();
    if (!(data.gap_scale > 0)) data.gap_scale = 1;
    if (!(data.multiplier_scale > 0)) data.multiplier_scale = 1;
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
    double mean[2];
    for (int alpha = 0; alpha < 2; ++alpha) {
      // what the Dirichlet data exert on the unknowns moves to the right
      Vector held(space_->map());
      space_->forces(*scene_.tension[alpha], lift_[alpha], held);
      membranes.load[alpha] = Teuchos::rcp(new Vector(*body_[alpha], Teuchos::Copy));
      membranes.load[alpha]->update(-1, held, 1);
      Vector diagonal(space_->map());
      membranes.matrix[alpha]->getLocalDiagCopy(diagonal);
      mean[alpha] = membranes.factor[alpha] * diagonal.meanValue();
    }
    if (space_->map()->getGlobalNumElements() > 0)
      for (int alpha = 0; alpha < 2; ++alpha) membranes.theta[alpha] = mean[alpha] / (mean[0] + mean[1]);
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
    check_boundary(scene_, boundary_of(scene_, mesh), mesh);
    if (case_name().empty()) check_data(scene_, method_, mesh);
    check_initial(initial_, mesh);
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
