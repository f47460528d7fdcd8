#pragma once
#include <memory>
#include <string>
#include <vector>

#include "thixis/mesh/mesh.hpp"

namespace thixis::output {

/// Where the values of a field sit.
enum class Centre { vertex, cell };

/// Values on the local vertices (cells) of a mesh; ghosts are not read.
struct FieldData {
  std::string name;
  Centre centre = Centre::vertex;
  std::vector<double> values;
};

/// Writes `fields.h5` and `fields.xdmf` (XDMF 3, relative paths): one file for all ranks, collectively, in the order of global ids, so
/// that the file does not depend on the number of ranks. Throws FileError on all ranks.
class FieldWriter {
 public:
  FieldWriter(const std::string& folder, const core::Comm& comm);
  ~FieldWriter();
  /// One grid with its fields. The mesh is written anew only when it differs from that of the previous call.
  void write(const mesh::Mesh& mesh, const std::vector<FieldData>& fields, double time);
  /// Finishes both files.
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace thixis::output
