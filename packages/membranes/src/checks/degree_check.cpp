#include "checks/degree_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "thixis/core/error.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/mesh/remoteness.hpp"

namespace thixis::membranes {
namespace {

constexpr double inside = 0.98;    ///< the lattice keeps away from faces, where data may jump
constexpr double visible = 1e-10;  ///< of a difference, in units of what rounding is a 1e-16th of

/// (-1)^i n over i.
std::vector<double> binomials(int n) {
  std::vector<double> b(n + 1, 1.0);
  for (int i = 1; i <= n; ++i) b[i] = -b[i - 1] * (n - i + 1) / i;
  return b;
}

/// A field in the cells and along the faces of a mesh.
class Examination {
 public:
  Examination(const mesh::Mesh& mesh, scene::FieldPtr interface, double t)
      : mesh_(mesh), host_(mesh::on_host(mesh)), interface_(std::move(interface)), t_(t) {}

  void in_cells(const std::string& name, const scene::FieldPtr& field) const {
    if (!named(field)) return;
    const int n = field->degree()->space + 1;
    for (LocalIndex K = 0; K < mesh_.owned_cells; ++K) {
      std::vector<double> x, y;
      for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j) {
          const double third = (1 - inside) / 3, a = third + inside * i / n, b = third + inside * j / n;
          const double lambda[3] = {1 - a - b, a, b};
          x.push_back(0), y.push_back(0);
          for (int v = 0; v < 3; ++v) {
            x.back() += lambda[v] * host_.coordinates(host_.cell_vertices(K, v), 0);
            y.back() += lambda[v] * host_.coordinates(host_.cell_vertices(K, v), 1);
          }
        }
      const auto at = [n](int i, int j) { return i * (n + 1) - i * (i - 1) / 2 + j; };
      const auto f = values(*field, x, y);
      const double known = known_as(*field, x, y, f);
      for (int a = 0; a <= n && !f.empty(); ++a) {
        const auto in_a = binomials(a), in_b = binomials(n - a);
        double difference = 0, size = 0;
        for (int i = 0; i <= a; ++i)
          for (int j = 0; j <= n - a; ++j) {
            difference += in_a[i] * in_b[j] * f[at(i, j)];
            size += std::abs(in_a[i] * in_b[j]) * std::max(std::abs(f[at(i, j)]), known);
          }
        judge(name, n - 1, difference, size, "in the cell", x[at(0, 0)], y[at(0, 0)]);
      }
    }
  }
  void along_faces(const std::string& name, const scene::FieldPtr& field, LocalIndex tag) const {
    if (!named(field)) return;
    const int n = field->degree()->space + 1;
    const auto factor = binomials(n);
    for (LocalIndex F = 0; F < mesh_.faces; ++F) {
      if (host_.face_tag(F) != tag) continue;
      std::vector<double> x, y;
      for (int i = 0; i <= n; ++i) {
        const double s = 0.5 * (1 - inside) + inside * i / n;
        const LocalIndex a = host_.face_vertices(F, 0), b = host_.face_vertices(F, 1);
        x.push_back((1 - s) * host_.coordinates(a, 0) + s * host_.coordinates(b, 0));
        y.push_back((1 - s) * host_.coordinates(a, 1) + s * host_.coordinates(b, 1));
      }
      const auto f = values(*field, x, y);
      const double known = known_as(*field, x, y, f);
      double difference = 0, size = 0;
      for (std::size_t i = 0; i < f.size(); ++i) {
        difference += factor[i] * f[i];
        size += std::abs(factor[i]) * std::max(std::abs(f[i]), known);
      }
      judge(name, n - 1, difference, size, "on the face", x[0], y[0]);
    }
  }

 private:
  static bool named(const scene::FieldPtr& field) { return field && field->degree() && !field->degree()->whole; }

  /// Nothing where the interface passes between the points.
  std::vector<double> values(const scene::Field& field, const std::vector<double>& x, const std::vector<double>& y) const {
    std::vector<double> f(x.size());
    const scene::Points points{x.size(), x.data(), y.data()};
    if (interface_) {
      interface_->evaluate(points, t_, f.data());
      bool below = false, above = false;
      for (const double value : f) (value < 0 ? below : above) = true;
      if (below && above) return {};
    }
    field.evaluate(points, t_, f.data());
    return f;
  }
  /// Values have the rounding of numbers of this size.
  static double known_as(const scene::Field& field, const std::vector<double>& x, const std::vector<double>& y,
                         const std::vector<double>& f) {
    if (f.empty()) return 0;
    const auto [low, high] = std::minmax_element(f.begin(), f.end());
    const double by_place = mesh::remoteness(static_cast<int>(x.size()), [&](int i, int d) { return d == 0 ? x[i] : y[i]; });
    return std::max(field.cancelled(), by_place * (*high - *low));
  }
  static void judge(const std::string& name, int degree, double difference, double size, const char* where, double x, double y) {
    if (std::abs(difference) > visible * size)
      throw core::InputError(
          fmt::format("scene/data/degree: {} is no polynomial of degree {} {} at ({:.6g}, {:.6g}); write a higher degree, lay jumps and "
                      "kinks on faces of the mesh or on 'interface', or leave the degree out.",
                      name, degree, where, x, y));
  }

  const mesh::Mesh& mesh_;
  mesh::HostMesh host_;
  scene::FieldPtr interface_;
  double t_;
};

}  // namespace

void check_degrees(const MembraneScene& scene, const Boundary& boundary, const mesh::Mesh& mesh, double t) {
  mesh.comm.together([&] {
    const Examination examine(mesh, scene.interface_level_set, t);
    const auto name = [&](const char* letter, int alpha) { return scene.count == 1 ? letter : letter + std::to_string(alpha + 1); };
    examine.in_cells("psi", scene.obstacle);
    for (int alpha = 0; alpha < scene.count; ++alpha) {
      examine.in_cells(name("mu", alpha), scene.tension[alpha]);
      examine.in_cells(name("f", alpha), scene.force[alpha]);
      for (std::size_t tag = 0; tag < boundary.dirichlet.size(); ++tag) {
        examine.along_faces(name("g", alpha), boundary.values[alpha].dirichlet[tag], static_cast<LocalIndex>(tag));
        examine.along_faces(name("t", alpha), boundary.values[alpha].neumann[tag], static_cast<LocalIndex>(tag));
      }
    }
  });
}

}  // namespace thixis::membranes
