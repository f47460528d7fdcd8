#pragma once
#include <string>

namespace thixis::output {

/// A folder that this process alone writes to, as long as it lives: flock on the folder itself, which leaves nothing behind and ends with
/// the process, however that ends. Programs on other machines see it where the file system shows locks to them.
class FolderLock {
 public:
  /// Throws FileError if another one has it. Where a file system knows no locks there is none.
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int folder_ = -1;
};

}  // namespace thixis::output
