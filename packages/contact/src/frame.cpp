#include "thixis/contact/frame.hpp"

#include <Teuchos_SerialDenseMatrix.hpp>
#include <Teuchos_SerialDenseSolver.hpp>
#include <cmath>
#include <stdexcept>

namespace thixis::contact {
namespace {

using Dense = Teuchos::SerialDenseMatrix<int, double>;

void multiply(const Dense& A, Teuchos::ETransp transA, const Dense& B, Dense& C) { C.multiply(transA, Teuchos::NO_TRANS, 1, A, B, 0); }

Dense inverse(Dense A) {
  Teuchos::SerialDenseSolver<int, double> solver;
  solver.setMatrix(Teuchos::rcpFromRef(A));
  if (solver.invert() != 0) throw std::logic_error("The gaps of a contact point depend on each other.");
  return A;
}

Dense dense(const Small& small, int rows, int columns) {
  Dense A(rows, columns);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) A(i, j) = small(i, j);
  return A;
}

Small small(const Dense& A) {
  Small result;
  for (int i = 0; i < A.numRows(); ++i)
    for (int j = 0; j < A.numCols(); ++j) result(i, j) = A(i, j);
  return result;
}

double length(const Dense& A, int column) {
  double sum = 0;
  for (int i = 0; i < A.numRows(); ++i) sum += A(i, column) * A(i, column);
  return std::sqrt(sum);
}

int longest_column(const Dense& A) {
  int longest = 0;
  for (int j = 1; j < A.numCols(); ++j)
    if (length(A, j) > length(A, longest) * (1 + 1e-12)) longest = j;
  return longest;
}

/// A number that is a whole one but for rounding is that one: fields that move together do so to the last digit.
double whole(double x) { return std::abs(x - std::round(x)) < 1e-14 ? std::round(x) : x; }

/// A column of P as a mean, its largest entry 1, into column `to` of T; what is along it is taken out of P.
void take_mean(Dense& P, Dense& T, int to) {
  const int from = longest_column(P), m = P.numRows();
  const double size = length(P, from);
  double largest = 0;
  for (int i = 0; i < m; ++i)
    if (std::abs(P(i, from)) > std::abs(largest) * (1 + 1e-12)) largest = P(i, from);
  std::vector<double> direction(m);
  for (int i = 0; i < m; ++i) {
    T(i, to) = whole(P(i, from) / largest);
    direction[i] = P(i, from) / size;
  }
  for (int j = 0; j < P.numCols(); ++j) {
    double along = 0;
    for (int i = 0; i < m; ++i) along += direction[i] * P(i, j);
    for (int i = 0; i < m; ++i) P(i, j) -= along * direction[i];
  }
}

}  // namespace

Frame make_frame(int fields, int gaps, const Small& gaps_of, const std::vector<double>& weight) {
  const int means = fields - gaps;
  const Dense B = dense(gaps_of, fields, gaps);
  Dense softened(B), flexibility(gaps, gaps), open(fields, gaps), projection(fields, fields);
  for (int i = 0; i < fields; ++i)
    for (int g = 0; g < gaps; ++g) softened(i, g) /= weight[i];
  multiply(B, Teuchos::TRANS, softened, flexibility);
  multiply(softened, Teuchos::NO_TRANS, inverse(flexibility), open);

  // 1 - T_z Bᵀ projects on what leaves the gaps as they are
  projection.multiply(Teuchos::NO_TRANS, Teuchos::TRANS, -1, open, B, 0);
  for (int i = 0; i < fields; ++i) projection(i, i) += 1;
  Dense T(fields, fields);
  for (int j = 0; j < means; ++j) take_mean(projection, T, j);
  for (int g = 0; g < gaps; ++g)
    for (int i = 0; i < fields; ++i) T(i, means + g) = open(i, g);
  Dense back = inverse(T);
  for (int g = 0; g < gaps; ++g)
    for (int i = 0; i < fields; ++i) back(means + g, i) = B(i, g);  // what rounding makes of it is no gap
  return {small(T), small(back)};
}

Frames::Frames(const std::vector<Frame>& frames, const Kokkos::View<const int*>& kind_of_node) : kind(kind_of_node) {
  const Kokkos::View<Small*> all("thixis::contact::frames", frames.size()), back("thixis::contact::inverse_frames", frames.size());
  const auto all_host = Kokkos::create_mirror_view(all), back_host = Kokkos::create_mirror_view(back);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    all_host(k) = frames[k].T;
    back_host(k) = frames[k].inverse;
  }
  Kokkos::deep_copy(all, all_host);
  Kokkos::deep_copy(back, back_host);
  T = all;
  inverse = back;
}

}  // namespace thixis::contact
