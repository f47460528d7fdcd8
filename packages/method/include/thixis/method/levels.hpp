#pragma once
#include <map>

#include "thixis/method/method.hpp"
#include "thixis/method/transfer.hpp"

namespace thixis::method {

class Hats;

/// What lives on the levels of a hierarchy of meshes: the space of a method on each, the transfers P_j from one to the next, the forms of a
/// scene. Made when first asked for, and kept until the run lets go of it. Calls are collective.
class Levels {
 public:
  /// `options`: of the space on a mesh. The hierarchy must outlive it, and may get more levels.
  Levels(const mesh::Hierarchy& hierarchy, Method method, std::function<SpaceOptions(const mesh::Mesh&)> options);
  ~Levels();
  Levels(const Levels&) = delete;
  Levels& operator=(const Levels&) = delete;

  const mesh::Hierarchy& hierarchy() const { return hierarchy_; }
  const Method& method() const { return method_; }

  /// Lives as long as somebody holds it.
  std::shared_ptr<Space> space(int level);
  /// (mu grad u, grad v) on that space, one form for each tension.
  FormPtr diffusion(int level, const scene::FieldPtr& tension);
  /// P_level, from the level before. Valid as long as both levels are kept.
  const Transfer& transfer(int level);
  /// The coarser functions below the space of that level, as multigrid takes them (algebra::Nodes::below): hats of its mesh, unless they
  /// are the space, and of all coarser ones that have any. Kept while finer levels may ask for them, whatever else is let go. Scalar
  /// spaces.
  std::vector<Teuchos::RCP<const algebra::Matrix>> below(int level);

  /// Lets go of all levels before this one, and of the transfer to it.
  void keep_from(int level);
  void keep_to(int level);                                       ///< … of those behind it
  int kept() const { return static_cast<int>(levels_.size()); }  ///< so many levels

 private:
  const Hats& hats(int level);
  /// From the hats of the level before.
  const Teuchos::RCP<const algebra::Matrix>& hats_in_finer(int level);

  struct LevelOfHats {
    std::unique_ptr<const Hats> hats;
    Teuchos::RCP<const algebra::Matrix> in_finer;
  };
  struct Level {
    std::shared_ptr<Space> space;
    std::map<scene::FieldPtr, FormPtr> diffusion;
    std::unique_ptr<const Transfer> transfer;
  };

  const mesh::Hierarchy& hierarchy_;
  Method method_;
  std::function<SpaceOptions(const mesh::Mesh&)> options_;
  std::map<int, Level> levels_;
  std::map<int, LevelOfHats> hats_;
};

}  // namespace thixis::method
