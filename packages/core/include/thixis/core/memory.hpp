#pragma once
namespace thixis::core {
/// Largest resident set of this process so far, in MB (10^6 bytes).
double peak_memory_mb();
}  // namespace thixis::core
