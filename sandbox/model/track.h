// The keys of what moves: a key a frame while it does, two for a rest of any length.
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace shatterbox::sandbox::model {

template <class Value>
class Track {
 public:
  /// Of the next frame.
  void add(int frame, const Value& value) {
    const std::size_t size = values_.size();
    if (size > 1 && values_[size - 1] == value && values_[size - 2] == value) {
      frames_.back() = frame;  // it goes on resting
      return;
    }
    frames_.push_back(frame);
    values_.push_back(value);
  }

  const Value& first() const { return values_.front(); }
  const Value& last() const { return values_.back(); }
  bool moves() const { return values_.size() > 2 || (values_.size() == 2 && values_[0] != values_[1]); }
  const std::vector<int>& frames() const { return frames_; }
  const std::vector<Value>& values() const { return values_; }

 private:
  std::vector<int> frames_;
  std::vector<Value> values_;
};

}  // namespace shatterbox::sandbox::model
