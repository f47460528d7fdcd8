#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "thixis/hho/space.hpp"
#include "thixis/mesh/build.hpp"
#include "thixis/scene/field.hpp"

namespace thixis::hho {

inline mesh::Hierarchy hierarchy(mesh::Generator generator, int refinements, const core::Comm& comm = core::Comm()) {
  mesh::MeshParams params;
  params.generator = generator;
  params.refinements = refinements;
  params.cells_per_rank = 20;
  if (generator == mesh::Generator::rectangle) params.lower = {-1, 0.5}, params.upper = {2, 2};
  if (generator == mesh::Generator::disk) params.rings = 3;
  if (generator == mesh::Generator::file) params.file = "l_shape_22.msh";
  return mesh::build(params, comm, MESH_FILES);
}

struct Setting {
  mesh::Generator generator;
  int degree;
  method::Nodes nodes;
};

inline std::vector<Setting> settings() {
  std::vector<Setting> all;
  for (const auto generator : {mesh::Generator::criss_cross, mesh::Generator::rectangle, mesh::Generator::disk, mesh::Generator::file})
    for (int p = 1; p <= 4; ++p)
      for (const auto nodes : {method::Nodes::gauss_lobatto, method::Nodes::equispaced, method::Nodes::bernstein})
        if (p > 1 || nodes == method::Nodes::gauss_lobatto) all.push_back({generator, p, nodes});
  return all;
}

inline std::string name(const Setting& setting) {
  const char* const generators[] = {"criss_cross", "rectangle", "disk", "gmsh"};
  const char* const nodes[] = {"gauss_lobatto", "equispaced", "bernstein"};
  return std::string(generators[static_cast<int>(setting.generator)]) + "_P" + std::to_string(setting.degree) + "_" +
         nodes[static_cast<int>(setting.nodes)];
}

inline method::MethodParams params(int degree, method::Nodes nodes = method::Nodes::gauss_lobatto) {
  method::MethodParams params;
  params.name = "hho";
  params.degree = degree;
  params.nodes = nodes;
  return params;
}

inline std::unique_ptr<method::Space> space(const mesh::Mesh& mesh, const method::MethodParams& params, bool held) {
  return make_space(mesh, {std::vector<bool>(mesh.tags.size(), held), nullptr, params});
}

/// u = (0.3 + x - y/2)^p + x - y.
struct Polynomial {
  int p;
  static double inner(double x, double y) { return 0.3 + x - 0.5 * y; }
  double operator()(double x, double y) const { return std::pow(inner(x, y), p) + x - y; }
  double dx(double x, double y) const { return p * std::pow(inner(x, y), p - 1) + 1; }
  double dy(double x, double y) const { return -0.5 * p * std::pow(inner(x, y), p - 1) - 1; }
  double minus_laplacian(double x, double y) const { return p < 2 ? 0 : -1.25 * p * (p - 1) * std::pow(inner(x, y), p - 2); }

  scene::FieldPtr value() const { return scene::formula(*this); }
  method::Gradient gradient() const {
    return {scene::formula([u = *this](double x, double y) { return u.dx(x, y); }),
            scene::formula([u = *this](double x, double y) { return u.dy(x, y); })};
  }
};

}  // namespace thixis::hho
