#pragma once

/// All of Carom: include this one.
#include "carom/body.hpp"
#include "carom/collide.hpp"
#include "carom/driver.hpp"
#include "carom/error.hpp"
#include "carom/events.hpp"
#include "carom/forces.hpp"
#include "carom/ids.hpp"
#include "carom/inertia.hpp"
#include "carom/mass.hpp"
#include "carom/queries.hpp"
#include "carom/rotation.hpp"
#include "carom/shapes.hpp"
#include "carom/transform.hpp"
#include "carom/vec.hpp"
#include "carom/version.hpp"
#include "carom/world.hpp"
