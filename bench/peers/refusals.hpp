#pragma once

namespace carom::subject {

/// Was a world of this dimension asked for something that its engine does not have, since `forget_refusals`?
bool refused(int dimension);
void forget_refusals();

}  // namespace carom::subject
