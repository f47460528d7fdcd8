#pragma once
#include <cstdint>
#include <vector>

#include "thixis/algebra/fwd.hpp"

namespace thixis::complementarity {

/// What becomes of a point where K_l = s_l G_l. It decides how many steps a cold start needs: from X = 0 every point is a tie.
enum class Ties { contact, free };

/// The contact points where Newton-min takes the K-row: K_l < s_l G_l, and the ties if they go to contact. A tie is
///
///     |K_l - s_l G_l| <= tie        (0: exact equality),
///
/// which is to be a small part of the gaps that matter, e.g. of `largest_argument`: with a scaling s in physical units the set does then
/// not change with the units.
class ActiveSet {
 public:
  ActiveSet() = default;  ///< no points
  /// Collective on the map of the points. K, G, s on the same map.
  ActiveSet(const algebra::Vector& K, const algebra::Vector& G, const algebra::Vector& s, Ties ties, double tie);
  /// Anew, in the memory that it has.
  void set(const algebra::Vector& K, const algebra::Vector& G, const algebra::Vector& s, Ties ties, double tie);

  const std::vector<std::uint8_t>& flags() const { return flags_; }  ///< one per local point: 1 contact, 0 free
  long long count() const { return count_; }                         ///< contact points on all ranks
  /// Σ hash(global id) over the contact points of all ranks, modulo 2^64: equal sets have equal fingerprints on any number of ranks,
  /// as long as the ids do not depend on it; different sets collide with probability 2^-64.
  std::uint64_t fingerprint() const { return fingerprint_; }

  /// Points on all ranks whose flag differs, collective. `before` lives on the same map, or is a default-constructed set: nothing in
  /// contact.
  long long changed(const ActiveSet& before) const;

 private:
  std::vector<std::uint8_t> flags_;
  algebra::MapPtr map_;
  long long count_ = 0;
  std::uint64_t fingerprint_ = 0;
};

/// max_l max(|K_l|, s_l |G_l|) over all ranks. Collective.
double largest_argument(const algebra::Vector& K, const algebra::Vector& G, const algebra::Vector& s);
/// max_l s_l |G_l| over all ranks. Collective.
double largest_multiplier(const algebra::Vector& G, const algebra::Vector& s);

}  // namespace thixis::complementarity
