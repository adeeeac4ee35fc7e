#pragma once

#include <stdexcept>
#include <string>

namespace carom {

/// Thrown for every input that cannot be simulated. The message names the field, the value that was
/// given and what is allowed, for example `radius: -1 is not positive`. The object on which the call
/// was made is as it was before the call.
class Error : public std::runtime_error {
  public:
    /// `message` is what `what()` will say.
    explicit Error(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace carom
