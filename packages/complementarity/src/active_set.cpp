#include "thixis/complementarity/active_set.hpp"

#include <cmath>

#include "views.hpp"

namespace thixis::complementarity {
namespace {

/// size = max_l max(|K_l|, s_l |G_l|)
struct LargestArgument {
  Read K, G, s;
  KOKKOS_FUNCTION void operator()(int l, double& size) const {
    const double x = std::abs(K(l)), y = std::abs(s(l) * G(l));
    const double larger = x < y ? y : x;
    if (size < larger) size = larger;
  }
};

/// flag_l = K_l - s_l G_l < 0, or a tie that goes to contact
struct Classify {
  Read K, G, s;
  double tie;        ///< ties are differences of at most this size
  bool tie_contact;  ///< what they become
  FlagsOut flags;    ///< out, overwritten
  KOKKOS_FUNCTION void operator()(int l) const {
    const double difference = K(l) - s(l) * G(l);
    const bool is_tie = std::abs(difference) <= tie;
    flags(l) = is_tie ? tie_contact : difference < 0;
  }
};

/// splitmix64: a bijection of 64-bit words without visible structure
std::uint64_t hash(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

}  // namespace

double largest_argument(const algebra::Vector& K, const algebra::Vector& G, const algebra::Vector& s) {
  double largest = 0;
  Kokkos::parallel_reduce("thixis::complementarity::largest argument",
                          Kokkos::RangePolicy<Execution>(0, static_cast<int>(K.getLocalLength())),
                          LargestArgument{read(K), read(G), read(s)}, Kokkos::Max<double>(largest));
  return comm_of(*K.getMap()).max(largest);
}

ActiveSet::ActiveSet(const algebra::Vector& K, const algebra::Vector& G, const algebra::Vector& s, Ties ties, double tie)
    : flags_(K.getLocalLength()), map_(K.getMap()) {
  const core::Comm comm = comm_of(*map_);
  const int points = static_cast<int>(flags_.size());
  Kokkos::parallel_for("thixis::complementarity::active set", Kokkos::RangePolicy<Execution>(0, points),
                       Classify{read(K), read(G), read(s), tie, ties == Ties::contact, FlagsOut(flags_.data(), flags_.size())});
  Execution().fence();

  // The two halves of the hashes are summed apart: no sum of 64-bit words overflows below 2^31 points.
  std::vector<long long> sums(3, 0);
  for (int l = 0; l < points; ++l) {
    if (!flags_[l]) continue;
    const std::uint64_t h = hash(static_cast<std::uint64_t>(map_->getGlobalElement(l)));
    sums[0] += 1;
    sums[1] += static_cast<long long>(h & 0xffffffffULL);
    sums[2] += static_cast<long long>(h >> 32);
  }
  comm.sum(sums);
  count_ = sums[0];
  fingerprint_ = static_cast<std::uint64_t>(sums[1]) + (static_cast<std::uint64_t>(sums[2]) << 32);
}

long long ActiveSet::changed(const ActiveSet& before) const {
  if (map_.is_null()) return before.count_;
  if (before.map_.is_null()) return count_;
  long long differences = 0;
  for (std::size_t l = 0; l < flags_.size(); ++l) differences += flags_[l] != before.flags_[l];
  return comm_of(*map_).sum(differences);
}

}  // namespace thixis::complementarity
