// sim_node/scene/liaisons/include.h -- files that a section of a scene reads besides its own.
#pragma once

#include <string>
#include <vector>

#include "node/config/value.h"

namespace cordis::scene {

/// The files that one section includes: each is read once, and none includes itself.
class Includes {
 public:
  explicit Includes(config::Problems& problems) : problems_(problems) {}

  /// A file is being read as long as it lives.
  class Open {
   public:
    Open(Includes& includes, const std::string& file);
    ~Open() { includes_.open_.pop_back(); }
    Open(const Open&) = delete;
    Open& operator=(const Open&) = delete;

   private:
    Includes& includes_;
  };

  /// A file that is to be read now.
  struct File {
    std::string path;
    config::Value root;  ///< exists
  };

  /// Reads the files that `include: path` or `include: [paths]` names, relative to the folder of
  /// `from_file`; those that have been read before are left out.
  std::vector<File> read(const config::Value& paths, const std::string& from_file);

 private:
  config::Problems& problems_;
  std::vector<std::string> open_;   // canonical paths from the scene down to the present file
  std::vector<std::string> known_;  // of all that have been read
};

}  // namespace cordis::scene
