// All of Motes that a program which uses it needs: #include <motes/motes.h>
#pragma once

#include "core/error.h"
#include "core/report.h"
#include "core/vec.h"
#include "field/probe.h"
#include "image/framebuffer.h"
#include "image/write_image.h"
#include "io/reader.h"
#include "particles/particle_set.h"
#include "render/renderer.h"
#include "render/resolve.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "scene/transfer_function.h"
