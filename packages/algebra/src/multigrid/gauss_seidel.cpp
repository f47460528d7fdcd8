#include "multigrid/gauss_seidel.hpp"

#include <algorithm>

namespace thixis::algebra {
namespace {

using Range = Kokkos::RangePolicy<Node::execution_space>;
using Rows = GaussSeidel::Rows;
using In = decltype(std::declval<const Vector&>().getLocalViewDevice(Tpetra::Access::ReadOnly));
using Out = decltype(std::declval<Vector&>().getLocalViewDevice(Tpetra::Access::ReadWrite));

/// Gives each row the first colour that no neighbour has. Symbolic: once per graph, on the host.
std::vector<int> colours(const Graph& graph) {
  const auto local = graph.getLocalGraphDevice();
  const auto begin = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), local.row_map);
  const auto column = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), local.entries);
  const LocalIndex rows = local_rows(graph);
  std::vector<int> colour(rows, -1);
  std::vector<LocalIndex> taken_by;
  for (LocalIndex i = 0; i < rows; ++i) {
    for (auto k = begin(i); k < begin(i + 1); ++k)
      if (column(k) < rows && colour[column(k)] >= 0) taken_by[colour[column(k)]] = i;
    int free = 0;
    while (free < static_cast<int>(taken_by.size()) && taken_by[free] == i) ++free;
    if (free == static_cast<int>(taken_by.size())) taken_by.push_back(-1);
    colour[i] = free;
  }
  return colour;
}

template <class T>
Kokkos::View<const T*> to_device(const std::string& label, const std::vector<T>& values) {
  const Kokkos::View<T*> view(label, values.size());
  Kokkos::deep_copy(view, Kokkos::View<const T*, Kokkos::HostSpace>(values.data(), values.size()));
  return view;
}

/// The length of each row without its diagonal.
struct Lengths {
  Graph::local_graph_device_type graph;
  Rows out;

  KOKKOS_FUNCTION void operator()(LocalIndex i, std::size_t& sum, bool last) const {
    if (last) out.begin(i) = sum;
    if (i + 1 == out.begin.extent_int(0)) return;
    const LocalIndex row = out.row(i);
    for (auto k = graph.row_map(row); k < graph.row_map(row + 1); ++k) sum += graph.entries(k) != row;
  }
};

/// Sorts the entries of each row into its three parts.
struct Sort {
  Matrix::local_matrix_device_type A;
  Kokkos::View<const LocalIndex*> position;
  Rows out;

  KOKKOS_FUNCTION void operator()(LocalIndex i) const {
    const LocalIndex row = out.row(i);
    const std::size_t first = A.graph.row_map(row), last = A.graph.row_map(row + 1);
    std::size_t before = 0, behind = 0;
    for (std::size_t k = first; k < last; ++k) {
      const LocalIndex c = A.graph.entries(k);
      if (c == row || c >= position.extent_int(0)) continue;
      if (position(c) < i) ++before;
      else ++behind;
    }
    std::size_t to[3] = {out.begin(i), out.begin(i) + before, out.begin(i) + before + behind};
    out.behind(i) = to[1];
    out.remote(i) = to[2];
    double diagonal = 0, strength = 0;
    for (std::size_t k = first; k < last; ++k) {
      const LocalIndex c = A.graph.entries(k);
      const double a = A.values(k);
      if (c == row) {
        diagonal = a;
        continue;
      }
      const int part = c >= position.extent_int(0) ? 2 : position(c) < i ? 0 : 1;
      if (part == 2) strength += a < 0 ? -a : a;
      out.column(to[part]) = c;
      out.value(to[part]++) = a;
    }
    out.diagonal(i) = diagonal;
    out.inverse(i) = 1 / (diagonal + (diagonal < 0 ? -strength : strength));
  }
};

struct Forward {
  Rows A;
  In b;
  Out x;  ///< rows of earlier colours are read, those of this one overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex i) const {
    double sum = b(A.row(i), 0);
    for (std::size_t k = A.begin(i); k < A.behind(i); ++k) sum -= A.value(k) * x(A.column(k), 0);
    x(A.row(i), 0) = sum * A.inverse(i);
  }
};

/// b - A x = l x - U x - A_o x after a forward sweep.
struct Residual {
  Rows A;
  In x, ghosted;
  Out r;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex i) const {
    const std::size_t remote = A.remote(i), end = A.begin(i + 1);
    double sum = 0;
    for (std::size_t k = A.behind(i); k < remote; ++k) sum -= A.value(k) * x(A.column(k), 0);
    for (std::size_t k = remote; k < end; ++k) sum -= A.value(k) * ghosted(A.column(k), 0);
    if (remote < end) sum += (1 / A.inverse(i) - A.diagonal(i)) * x(A.row(i), 0);
    r(A.row(i), 0) = sum;
  }
};

struct Backward {
  Rows A;
  In b, ghosted;
  Out x;  ///< updated

  KOKKOS_FUNCTION void operator()(LocalIndex i) const {
    const LocalIndex row = A.row(i);
    const std::size_t remote = A.remote(i), end = A.begin(i + 1);
    double sum = b(row, 0) - A.diagonal(i) * x(row, 0);
    for (std::size_t k = A.begin(i); k < remote; ++k) sum -= A.value(k) * x(A.column(k), 0);
    for (std::size_t k = remote; k < end; ++k) sum -= A.value(k) * ghosted(A.column(k), 0);
    x(row, 0) += sum * A.inverse(i);
  }
};

}  // namespace

GaussSeidel::GaussSeidel(const GraphPtr& graph) : graph_(graph) {
  const std::vector<int> colour = colours(*graph);
  const int count = colour.empty() ? 0 : 1 + *std::max_element(colour.begin(), colour.end());
  colour_.assign(count + 1, 0);
  for (const int c : colour) ++colour_[c + 1];
  for (int c = 0; c < count; ++c) colour_[c + 1] += colour_[c];
  std::vector<LocalIndex> row(colour.size()), position(colour.size()), next = colour_;
  for (LocalIndex i = 0; i < static_cast<LocalIndex>(colour.size()); ++i) row[position[i] = next[colour[i]]++] = i;
  rows_.row = to_device("thixis::algebra::row_by_colour", row);
  position_ = to_device("thixis::algebra::position_by_colour", position);

  const auto local = graph->getLocalGraphDevice();
  rows_.begin = Kokkos::View<std::size_t*>("thixis::algebra::begin_by_colour", row.size() + 1);
  rows_.behind = Kokkos::View<std::size_t*>("thixis::algebra::behind", row.size());
  rows_.remote = Kokkos::View<std::size_t*>("thixis::algebra::remote", row.size());
  std::size_t entries = 0;
  Kokkos::parallel_scan("thixis::algebra::row_lengths", Range(0, rows_.begin.extent(0)), Lengths{local, rows_}, entries);
  rows_.column = Kokkos::View<LocalIndex*>("thixis::algebra::columns_by_colour", entries);
  rows_.value = Kokkos::View<double*>("thixis::algebra::values_by_colour", entries);
  rows_.diagonal = Kokkos::View<double*>("thixis::algebra::diagonal", row.size());
  rows_.inverse = Kokkos::View<double*>("thixis::algebra::inverse_diagonal", row.size());
  if (!graph->getImporter().is_null()) ghosted_ = Teuchos::rcp(new Vector(graph->getColMap()));
}

void GaussSeidel::set_matrix(const Matrix& A) {
  Kokkos::parallel_for("thixis::algebra::sort_by_colour", Range(0, rows_.row.extent(0)), Sort{A.getLocalMatrixDevice(), position_, rows_});
}

template <class Kernel>
void GaussSeidel::for_colours(const char* label, const Kernel& kernel, bool backward) const {
  const int count = static_cast<int>(colour_.size()) - 1;
  for (int k = 0; k < count; ++k) {
    const int c = backward ? count - 1 - k : k;
    Kokkos::parallel_for(label, Range(colour_[c], colour_[c + 1]), kernel);
  }
}

void GaussSeidel::fetch(const Vector& x) const {
  if (!ghosted_.is_null()) ghosted_->doImport(x, *graph_->getImporter(), Tpetra::INSERT);
}

void GaussSeidel::forward(const Vector& b, Vector& x, Vector& r) const {
  for_colours("thixis::algebra::forward_sweep",
              Forward{rows_, b.getLocalViewDevice(Tpetra::Access::ReadOnly), x.getLocalViewDevice(Tpetra::Access::OverwriteAll)}, false);
  fetch(x);
  const Vector& known = x;
  const Vector& ghosted = ghosted_.is_null() ? known : *ghosted_;
  Kokkos::parallel_for("thixis::algebra::residual_of_sweep", Range(0, rows_.row.extent(0)),
                       Residual{rows_, known.getLocalViewDevice(Tpetra::Access::ReadOnly),
                                ghosted.getLocalViewDevice(Tpetra::Access::ReadOnly), r.getLocalViewDevice(Tpetra::Access::OverwriteAll)});
}

void GaussSeidel::backward(const Vector& b, Vector& x) const {
  fetch(x);
  Backward sweep{rows_, b.getLocalViewDevice(Tpetra::Access::ReadOnly), {}, {}};
  if (!ghosted_.is_null()) sweep.ghosted = std::as_const(*ghosted_).getLocalViewDevice(Tpetra::Access::ReadOnly);
  sweep.x = x.getLocalViewDevice(Tpetra::Access::ReadWrite);
  for_colours("thixis::algebra::backward_sweep", sweep, true);
}

}  // namespace thixis::algebra
