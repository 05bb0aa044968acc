// The pieces that the room is furnished with.
#pragma once

#include "counter_random.h"
#include "scene_builder.h"

namespace evolin::synthetic {

/// Colours that go together; a room has one set.
struct Palette {
  Material wall;
  Material feature_wall;
  Material ceiling;
  Material floor;
  Material trim;       ///< skirting, door and window frames
  Material wood;       ///< large furniture
  Material dark_wood;  ///< small furniture, picture frames
  Material fabric;
  Material curtain;
  Material metal;
  Material rug;
};

Palette makePalette(RandomStream* random);

/// `material` with a grain of its own.
Material varied(Material material, RandomStream* random);

// Each stands on the floor or hangs with its back at local y = 0, its front towards smaller y,
// local x = 0 at its left end; sizes in metres.

void addDesk(const Placement& place, const Palette& palette, RandomStream* random,
             SceneBuilder* scene);
void addChair(const Placement& place, const Palette& palette, RandomStream* random,
              SceneBuilder* scene);
void addBookcase(const Placement& place, const Palette& palette, RandomStream* random,
                 SceneBuilder* scene);
void addSideboard(const Placement& place, const Palette& palette, RandomStream* random,
                  SceneBuilder* scene);
void addCoffeeTable(const Placement& place, const Palette& palette, RandomStream* random,
                    SceneBuilder* scene);
void addFloorLamp(const Placement& place, const Palette& palette, SceneBuilder* scene);
void addRug(const Placement& place, double width, double depth, const Palette& palette,
            SceneBuilder* scene);

/// `low` is its lower left corner on the wall.
void addPicture(const Placement& place, const Vector3& low, double width, double height,
                const Palette& palette, RandomStream* random, SceneBuilder* scene);
void addDoor(const Placement& place, const Palette& palette, RandomStream* random,
             SceneBuilder* scene);

/// A rectangle on a wall: local x and z of two opposite corners.
struct Opening {
  double left = 0;
  double bottom = 0;
  double right = 0;
  double top = 0;
};

/// Reveal, sill, casement and the view behind `opening` of a wall at local y = 0, and its light.
void addWindow(const Placement& place, const Opening& opening, const Palette& palette,
               RandomStream* random, SceneBuilder* scene);

/// A rod over the window with a folded curtain at each side.
void addCurtains(const Placement& place, const Opening& window, const Palette& palette,
                 RandomStream* random, SceneBuilder* scene);

}  // namespace evolin::synthetic
