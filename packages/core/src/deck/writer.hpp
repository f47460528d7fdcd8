#pragma once
#include <string>

#include "deck/values.hpp"

namespace thixis::core {

/// Lines of a Teuchos XML deck.
class XmlWriter {
 public:
  void open(const std::string& name, const std::string& note = "");
  void close();
  void parameter(const std::string& name, const Written& value, const std::string& note = "");
  const std::string& text() const { return text_; }
  void hide(bool hidden) { hidden_ = hidden; }  ///< while hidden, every line is a comment
  bool hidden() const { return hidden_; }

 private:
  void line(const std::string& element, const std::string& note);
  std::string text_;
  int depth_ = 0;
  bool hidden_ = false;
};

}  // namespace thixis::core
