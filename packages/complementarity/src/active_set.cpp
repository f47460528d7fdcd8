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

/// size = max_l s_l |G_l|
struct LargestMultiplier {
  Read G, s;
  KOKKOS_FUNCTION void operator()(int l, double& size) const {
    const double y = std::abs(s(l) * G(l));
    if (size < y) size = y;
  }
};

/// splitmix64: a bijection of 64-bit words without visible structure
KOKKOS_INLINE_FUNCTION std::uint64_t hash(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// Contact points, and the sums over them of the two halves of their hashes: no sum of 64-bit words overflows below 2^31 points.
struct Fingerprint {
  FlagsOut flags;
  algebra::Map::local_map_type ids;
  KOKKOS_FUNCTION void operator()(int l, long long& count, long long& low, long long& high) const {
    if (!flags(l)) return;
    const std::uint64_t h = hash(static_cast<std::uint64_t>(ids.getGlobalElement(l)));
    count += 1;
    low += static_cast<long long>(h & 0xffffffffULL);
    high += static_cast<long long>(h >> 32);
  }
};

struct Differences {
  Flags now, before;
  KOKKOS_FUNCTION void operator()(int l, long long& count) const { count += now(l) != before(l); }
};

}  // namespace

double largest_argument(const algebra::Vector& K, const algebra::Vector& G, const algebra::Vector& s) {
  double largest = 0;
  Kokkos::parallel_reduce("thixis::complementarity::largest argument",
                          Kokkos::RangePolicy<Execution>(0, static_cast<int>(K.getLocalLength())),
                          LargestArgument{read(K), read(G), read(s)}, Kokkos::Max<double>(largest));
  return comm_of(*K.getMap()).max(largest);
}

double largest_multiplier(const algebra::Vector& G, const algebra::Vector& s) {
  double largest = 0;
  Kokkos::parallel_reduce("thixis::complementarity::largest multiplier",
                          Kokkos::RangePolicy<Execution>(0, static_cast<int>(G.getLocalLength())), LargestMultiplier{read(G), read(s)},
                          Kokkos::Max<double>(largest));
  return comm_of(*G.getMap()).max(largest);
}

ActiveSet::ActiveSet(const algebra::Vector& K, const algebra::Vector& G, const algebra::Vector& s, Ties ties, double tie) {
  set(K, G, s, ties, tie);
}

void ActiveSet::set(const algebra::Vector& K, const algebra::Vector& G, const algebra::Vector& s, Ties ties, double tie) {
  map_ = K.getMap();
  flags_.resize(K.getLocalLength());
  const FlagsOut flags(flags_.data(), flags_.size());
  const Kokkos::RangePolicy<Execution> points(0, static_cast<int>(flags_.size()));
  Classify classify;
  classify.K = read(K);
  classify.G = read(G);
  classify.s = read(s);
  classify.tie = tie;
  classify.tie_contact = ties == Ties::contact;
  classify.flags = flags;
  Kokkos::parallel_for("thixis::complementarity::active set", points, classify);
  std::vector<long long> sums(3);
  Kokkos::parallel_reduce("thixis::complementarity::fingerprint", points, Fingerprint{flags, map_->getLocalMap()}, sums[0], sums[1],
                          sums[2]);
  Execution().fence();
  comm_of(*map_).sum(sums);
  count_ = sums[0];
  fingerprint_ = static_cast<std::uint64_t>(sums[1]) + (static_cast<std::uint64_t>(sums[2]) << 32);
}

long long ActiveSet::changed(const ActiveSet& before) const {
  if (map_.is_null()) return before.count_;
  if (before.map_.is_null()) return count_;
  long long differences = 0;
  Kokkos::parallel_reduce("thixis::complementarity::changed", Kokkos::RangePolicy<Execution>(0, static_cast<int>(flags_.size())),
                          Differences{Flags(flags_.data(), flags_.size()), Flags(before.flags_.data(), before.flags_.size())}, differences);
  return comm_of(*map_).sum(differences);
}

}  // namespace thixis::complementarity
