#pragma once
/// The integer types of the program, named by their role.
namespace thixis {
using LocalIndex = int;         ///< an entity on this rank
using GlobalIndex = long long;  ///< an entity of the whole mesh or system
}  // namespace thixis
