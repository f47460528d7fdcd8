#pragma once
#include <string>
#include <utility>
#include <vector>

namespace thixis {

extern const char* const version_number;
extern const char* const version_git;

/// Name and version of the program and of what it is built on: thixis, git, trilinos, kokkos backend, mpi, hdf5, compiler.
std::vector<std::pair<std::string, std::string>> versions();

}  // namespace thixis
