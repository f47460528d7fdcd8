#include "flux_checks.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "thixis/mesh/host.hpp"

namespace thixis::equilibration {

double divergence_error(const mesh::Mesh& mesh, int q, const ConstCellTable& sigma, const ConstCellTable& r) {
  const reference::Modal modal(q + 1);
  const int N = modal.size(), n = reference::dimension(q);
  double worst = 0, size = 0;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    for (int m = 0; m < N; ++m) {
      double divergence = 0;
      for (int d = 0; d < 2; ++d)
        for (int l = 0; l < N; ++l) divergence += modal.derivative(d)[m * N + l] * sigma(K, d * N + l);
      const double wanted = m < n ? r(K, m) : 0;
      worst = std::max(worst, std::abs(divergence - wanted));
      size = std::max(size, std::abs(wanted));
    }
  return mesh.comm.max(worst) / std::max(mesh.comm.max(size), 1e-300);
}

double jump_of_normal_flux(const mesh::Mesh& mesh, int q, const ConstCellTable& sigma, const std::vector<bool>& held) {
  const reference::Modal modal(q + 1);
  const auto host = mesh::on_host(mesh);
  const int N = modal.size();
  struct Side {
    GlobalIndex face;
    int j;
    double moment;
  };
  std::vector<Side> sides;
  double worst = 0, size = 0;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    for (int i = 0; i < 3; ++i) {
      const auto trace = modal.trace(i, q + 2);
      const LocalIndex F = host.cell_faces(K, i), tag = host.face_tag(F);
      const bool along = host.face_vertices(F, 0) == host.cell_vertices(K, (i + 1) % 3);
      for (int j = 0; j < q + 2; ++j) {
        double moment = 0;
        for (int d = 0; d < 2; ++d)
          for (int l = 0; l < N; ++l) moment += reference::face_normal[i][d] * trace[j * N + l] * sigma(K, d * N + l);
        size = std::max(size, std::abs(moment));
        if (tag < 0) sides.push_back({mesh.face_id[F], j, along || j % 2 == 0 ? moment : -moment});
        else if (!held.empty() && !held[tag]) worst = std::max(worst, std::abs(moment));
      }
    }
  std::map<std::pair<GlobalIndex, int>, double> jump;
  for (const Side& side : mesh.comm.gather(sides)) jump[{side.face, side.j}] += side.moment;
  for (const auto& [key, value] : jump) worst = std::max(worst, std::abs(value));
  return mesh.comm.max(worst) / std::max(mesh.comm.max(size), 1e-300);
}

double energy(const mesh::Mesh& mesh, const ConstCellTable& sigma) {
  const auto metric = metrics(mesh, method::owned_cells(mesh));
  const int n = sigma.extent_int(1) / 2;
  double sum = 0;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) sum += metric(K).square(&sigma(K, 0), &sigma(K, n), n);
  return mesh.comm.sum(sum);
}

}  // namespace thixis::equilibration
