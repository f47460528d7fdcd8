#pragma once
#include <any>
#include <map>
#include <typeindex>

namespace thixis::core {

/// Structs that a block of the deck holds for packages that it does not know, one of each type (Schema::with). One that nobody has touched
/// has its defaults.
class Extras {
 public:
  template <class Q>
  const Q& get() const {
    static const Q untouched{};
    const auto found = all_.find(typeid(Q));
    return found == all_.end() ? untouched : *std::any_cast<Q>(&found->second);
  }
  template <class Q>
  Q& get() {
    std::any& place = all_[typeid(Q)];
    return place.has_value() ? *std::any_cast<Q>(&place) : place.emplace<Q>();
  }

 private:
  std::map<std::type_index, std::any> all_;
};

}  // namespace thixis::core
