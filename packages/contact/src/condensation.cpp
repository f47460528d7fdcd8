#include "thixis/contact/condensation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "elimination.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/assert.hpp"
#include "thixis/core/error.hpp"

namespace thixis::contact {
namespace {

using method::block_size;
using method::make_graph;
using method::scatter;
using Execution = algebra::Graph::execution_space;
using Indices = Kokkos::View<const LocalIndex*>;

constexpr LocalIndex none = std::numeric_limits<LocalIndex>::max();

/// Local matrices of a block that fit, with their factors, into the second-level cache.
constexpr std::size_t cache = 1 << 18;

/// f(first, count) for blocks of elements.
template <class F>
void over_blocks(LocalIndex elements, LocalIndex length, F&& f) {
  for (LocalIndex first = 0; first < elements; first += length) f(first, std::min(length, elements - first));
}

Kokkos::View<LocalIndex*> on_device(const std::vector<LocalIndex>& host, const std::string& label) {
  const Kokkos::View<LocalIndex*> view(label, host.size());
  Kokkos::deep_copy(view, Kokkos::View<const LocalIndex*, Kokkos::HostSpace>(host.data(), host.size()));
  return view;
}

}  // namespace

struct Condensation::Impl {
  ElementUnknowns elements;   ///< original columns
  ElementUnknowns remaining;  ///< columns of the condensed graph, -1 for all that has none
  algebra::MapPtr rows;
  algebra::GraphPtr graph;
  algebra::MatrixPtr matrix;
  Indices original_row, condensed_column;
  LocalIndex kept = 0;  ///< all elements with interior unknowns on this rank come before
  LocalFactors factors;
  Block3 A;                               ///< a block of local matrices
  Block2 y;                               ///< a block of local vectors
  Teuchos::RCP<algebra::Vector> ghosted;  ///< what remains, with ghosts

  core::Comm comm() const { return algebra::comm_of(*rows); }

  void number(const algebra::MapPtr& all_rows, const algebra::MapPtr& all_columns, int interior) {
    const auto unknowns = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), elements);
    const int count = unknowns.extent_int(0), width = unknowns.extent_int(1);
    const LocalIndex row_count = algebra::local_size(*all_rows);

    std::vector<bool> eliminated(row_count, false);
    for (int e = 0; e < count; ++e)
      for (int i = 0; i < interior; ++i) {
        const LocalIndex row = unknowns(e, i);
        if (row < 0 || row >= row_count) continue;
        THIXIS_ASSERT(!eliminated[row], "row {} is interior to element {} alone", row, e);
        eliminated[row] = true;
        kept = e + 1;
      }
    std::vector<LocalIndex> original;
    for (LocalIndex row = 0; row < row_count; ++row)
      if (!eliminated[row]) original.push_back(row);
    rows = algebra::contiguous_map(static_cast<LocalIndex>(original.size()), algebra::comm_of(*all_rows));

    // one number per unknown tells the ghosts: the id among those that remain, or -1
    algebra::Vector id(all_rows), ghosted_id(all_columns);
    id.putScalar(-1);
    {
      const auto values = algebra::host_view(id);
      for (std::size_t k = 0; k < original.size(); ++k)
        values(original[k]) = static_cast<double>(rows->getGlobalElement(static_cast<LocalIndex>(k)));
    }
    ghosted_id.doImport(id, algebra::Import(all_rows, all_columns), Tpetra::INSERT);
    std::vector<LocalIndex> condensed(algebra::local_size(*all_columns), -1);
    std::vector<GlobalIndex> ids;
    {
      const auto values = algebra::host_view(std::as_const(ghosted_id));
      for (std::size_t column = 0; column < condensed.size(); ++column) {
        if (values(column) < 0) continue;
        condensed[column] = static_cast<LocalIndex>(ids.size());
        ids.push_back(static_cast<GlobalIndex>(values(column)));
      }
    }

    const Kokkos::View<LocalIndex**, Kokkos::LayoutRight> left("thixis::contact::remaining", count, width);
    const auto host = Kokkos::create_mirror_view(left);
    for (int e = 0; e < count; ++e)
      for (int i = 0; i < width; ++i) host(e, i) = i < interior || unknowns(e, i) < 0 ? -1 : condensed[unknowns(e, i)];
    Kokkos::deep_copy(left, host);
    remaining = left;
    original_row = on_device(original, "thixis::contact::original_row");
    condensed_column = on_device(condensed, "thixis::contact::condensed_column");
    graph = make_graph(rows, algebra::map_of(ids, comm()), remaining);
  }
};

Condensation::Condensation(const algebra::MapPtr& rows, const algebra::MapPtr& columns, const ElementUnknowns& elements, int interior,
                           LocalForm form)
    : impl_(std::make_unique<Impl>()) {
  impl_->elements = elements;
  impl_->number(rows, columns, interior);
  impl_->matrix = Teuchos::rcp(new algebra::Matrix(impl_->graph));
  impl_->matrix->fillComplete();
  if (!impl_->graph->getImporter().is_null()) impl_->ghosted = Teuchos::rcp(new algebra::Vector(impl_->graph->getColMap(), false));

  const int n = elements.extent_int(1), count = elements.extent_int(0);
  impl_->factors = LocalFactors(impl_->kept, n, interior, form == LocalForm::positive_definite);
  const std::size_t bytes = sizeof(double) * n * n;
  const std::size_t length = Execution().concurrency() * std::clamp<std::size_t>(cache / std::max<std::size_t>(bytes, 1), 1, block_size);
  impl_->A = Block3("thixis::contact::local_matrices", std::min<std::size_t>(length, count), n, n);
  impl_->y = Block2("thixis::contact::local_vectors", std::min<std::size_t>(block_size, count), n);
}

Condensation::~Condensation() = default;

algebra::MapPtr Condensation::rows() const { return impl_->rows; }
algebra::GraphPtr Condensation::graph() const { return impl_->graph; }
const algebra::MatrixPtr& Condensation::matrix() const { return impl_->matrix; }
const Indices& Condensation::original_row() const { return impl_->original_row; }
const Indices& Condensation::condensed_column() const { return impl_->condensed_column; }

void Condensation::set_matrix(const FillLocalMatrices& local) {
  const Impl& d = *impl_;
  Kokkos::deep_copy(d.matrix->getLocalMatrixDevice().values, 0);
  d.comm().together([&] {
    over_blocks(d.elements.extent_int(0), d.A.extent_int(0), [&](LocalIndex first, LocalIndex count) {
      const auto A = Kokkos::subview(d.A, std::pair(0, count), Kokkos::ALL, Kokkos::ALL);
      local(first, A);
      LocalIndex singular = none;
      Kokkos::parallel_reduce("thixis::contact::eliminate", Kokkos::RangePolicy<Execution>(0, count),
                              Eliminate{d.elements, first, d.kept, A, d.factors}, Kokkos::Min<LocalIndex>(singular));
      if (singular != none)
        throw core::InputError(
            fmt::format("mesh/refinements: the interior unknowns of element {} can not be eliminated, since their matrix is {}: a tension "
                        "that varies by too many orders of magnitude inside a cell does that; write finer cells, a lower method/degree, "
                        "or method/name = fem.",
                        singular, d.factors.symmetric ? "not positive definite" : "singular"));
      scatter(d.remaining, first, A, *d.matrix);
    });
  });
}

void Condensation::reduce(const algebra::Vector& b, algebra::Vector& b_condensed) const {
  const Impl& d = *impl_;
  const auto values = b.getLocalViewDevice(Tpetra::Access::ReadOnly);
  algebra::Vector shares(d.graph->getColMap());
  over_blocks(d.kept, d.y.extent_int(0), [&](LocalIndex first, LocalIndex count) {
    const auto y = Kokkos::subview(d.y, std::pair(0, count), Kokkos::ALL);
    Kokkos::parallel_for("thixis::contact::reduce", Kokkos::RangePolicy<Execution>(0, count),
                         Reduce{d.elements, first, d.factors, values, y});
    scatter(d.remaining, first, y, shares);
  });
  b_condensed.putScalar(0);
  const auto import = d.graph->getImporter();
  if (import.is_null()) b_condensed.assign(shares);
  else b_condensed.doExport(shares, *import, Tpetra::ADD);

  const auto original_row = d.original_row;
  const auto sum = b_condensed.getLocalViewDevice(Tpetra::Access::ReadWrite);
  Kokkos::parallel_for(
      "thixis::contact::reduce_own", Kokkos::RangePolicy<Execution>(0, original_row.extent_int(0)),
      KOKKOS_LAMBDA(int row) { sum(row, 0) += values(original_row(row), 0); });
}

void Condensation::recover(const algebra::Vector& b, const algebra::Vector& x_condensed, algebra::Vector& x) const {
  const Impl& d = *impl_;
  const auto import = d.graph->getImporter();
  if (!import.is_null()) d.ghosted->doImport(x_condensed, *import, Tpetra::INSERT);
  const algebra::Vector& with_ghosts = import.is_null() ? x_condensed : *d.ghosted;
  const auto given = b.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const Input remaining = with_ghosts.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto values = x.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  const auto original_row = d.original_row;
  Kokkos::parallel_for(
      "thixis::contact::recover_own", Kokkos::RangePolicy<Execution>(0, original_row.extent_int(0)),
      KOKKOS_LAMBDA(int row) { values(original_row(row), 0) = remaining(row, 0); });
  over_blocks(d.kept, d.y.extent_int(0), [&](LocalIndex first, LocalIndex count) {
    const auto y = Kokkos::subview(d.y, std::pair(0, count), Kokkos::ALL);
    Recover kernel;
    kernel.elements = d.elements;
    kernel.remaining = d.remaining;
    kernel.first = first;
    kernel.factors = d.factors;
    kernel.b = given;
    kernel.x_remaining = remaining;
    kernel.y = y;
    kernel.x = values;
    Kokkos::parallel_for("thixis::contact::recover", Kokkos::RangePolicy<Execution>(0, count), kernel);
  });
}

}  // namespace thixis::contact
