/// The one file that names every method and every family of models: a line each.
#include "registry.hpp"

// The first method is the default.
#define THIXIS_METHODS(ENTRY) \
  ENTRY(fem)                  \
  ENTRY(dg)                   \
  ENTRY(hho)                  \
  ENTRY(fv)

#define THIXIS_FAMILIES(FAMILY) \
  FAMILY(membranes)             \
  FAMILY(flow)

#define DECLARED(package)     \
  namespace thixis::package { \
  method::Method entry();     \
  }
THIXIS_METHODS(DECLARED)
#undef DECLARED
#define DECLARED(package)     \
  namespace thixis::package { \
  models::Family family();    \
  }
THIXIS_FAMILIES(DECLARED)

namespace thixis {

const models::Catalogue& catalogue() {
#define ENTRY(package) package::entry(),
#define FAMILY(package) package::family(),
  static const models::Catalogue all({THIXIS_METHODS(ENTRY)}, {THIXIS_FAMILIES(FAMILY)});
  return all;
}

}  // namespace thixis
