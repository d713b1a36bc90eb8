// SPDX-License-Identifier: Apache-2.0
// The passes of a frame on a Vulkan device. They are recorded in the order of the calls and run
// together, in few command buffers; pixels and layers stay on the device until the frame is done.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "compose/filter_frame.h"
#include "compose/filter_records.h"
#include "compose/frame_passes.h"
#include "compose/frame_records.h"
#include "compose/frame_vulkan_memory.h"
#include "compose/motion/motion_records.h"
#include "compose/pixel_math.h"
#include "denoise/denoise_vulkan.h"
#include "field/correction/correction_use.h"
#include "field/secondary/secondary_math.h"
#include "field/secondary/secondary_records.h"
#include "fog/fog_records.h"
#include "gather/gather_records.h"
#include "gather/guide.h"
#include "glossy/glossy_records.h"
#include "raytracing/vulkan/device_world.h"
#include "raytracing/vulkan/hit_shading.h"
#include "rsm/vulkan/direct_vulkan.h"
#include "rsm/vulkan/gather_vulkan.h"
#include "shaders/add_behind_comp.h"
#include "shaders/add_behind_light_comp.h"
#include "shaders/add_filtered_comp.h"
#include "shaders/camera_rays_comp.h"
#include "shaders/clearcoat_light_comp.h"
#include "shaders/coat_hits_comp.h"
#include "shaders/coat_light_comp.h"
#include "shaders/coat_rays_comp.h"
#include "shaders/coat_reuse_comp.h"
#include "shaders/compose_comp.h"
#include "shaders/fog_pixels_comp.h"
#include "shaders/further_rays_comp.h"
#include "shaders/gather_rays_comp.h"
#include "shaders/gather_sum_comp.h"
#include "shaders/hit_queries_comp.h"
#include "shaders/keep_behind_comp.h"
#include "shaders/keep_clearcoats_comp.h"
#include "shaders/keep_mirrored_bases_comp.h"
#include "shaders/keep_mirrored_comp.h"
#include "shaders/keep_pixels_comp.h"
#include "shaders/keep_through_comp.h"
#include "shaders/luminances_comp.h"
#include "shaders/motion_comp.h"
#include "shaders/motion_rays_comp.h"
#include "shaders/pixel_queries_comp.h"
#include "shaders/replace_light_comp.h"
#include "shaders/scale_layers_comp.h"
#include "shaders/secondary_light_comp.h"
#include "shaders/secondary_rays_comp.h"
#include "shaders/seen_distances_comp.h"
#include "shaders/show_clearcoats_comp.h"
#include "shaders/show_through_comp.h"
#include "shaders/shown_points_comp.h"
#include "shaders/split_paths_comp.h"
#include "shaders/start_through_comp.h"
#include "shaders/through_rays_comp.h"
#include "shaders/view_geometry_comp.h"
#include "temporal/taa_vulkan.h"
#include "vulkan/buffer.h"
#include "vulkan/kernel.h"
#include "vulkan/recorder.h"

namespace lambent {

/// Kernels of frames, owned by the device (Device::kept).
struct FrameKernels {
  explicit FrameKernels(const vulkan::Device& on) : device(on) {}

  const vulkan::Device& device;
  std::mutex in_use;  ///< Held for the time of a frame.
  vulkan::Kernel camera_rays{device, shaders::camera_rays_comp(), "camera rays"};
  vulkan::Kernel motion_rays{device, shaders::motion_rays_comp(), "motion rays"};
  vulkan::Kernel motion{device, shaders::motion_comp(), "motion"};
  vulkan::Kernel pixel_queries{device, shaders::pixel_queries_comp(), "pixel queries"};
  vulkan::Kernel gather_rays{device, shaders::gather_rays_comp(), "gather rays"};
  vulkan::Kernel hit_queries{device, shaders::hit_queries_comp(), "hit queries"};
  vulkan::Kernel secondary_rays{device, shaders::secondary_rays_comp(), "secondary rays"};
  vulkan::Kernel secondary_light{device, shaders::secondary_light_comp(), "secondary light"};
  vulkan::Kernel gather_sum{device, shaders::gather_sum_comp(), "gather sum"};
  vulkan::Kernel replace_light{device, shaders::replace_light_comp(), "replace light"};
  vulkan::Kernel view_geometry{device, shaders::view_geometry_comp(), "view geometry"};
  vulkan::Kernel coat_rays{device, shaders::coat_rays_comp(), "coat rays"};
  vulkan::Kernel coat_hits{device, shaders::coat_hits_comp(), "coat hits"};
  vulkan::Kernel further_rays{device, shaders::further_rays_comp(), "further coat rays"};
  vulkan::Kernel coat_light{device, shaders::coat_light_comp(), "coat light"};
  vulkan::Kernel coat_reuse{device, shaders::coat_reuse_comp(), "coat reuse"};
  vulkan::Kernel show_clearcoats{device, shaders::show_clearcoats_comp(), "show clearcoats"};
  vulkan::Kernel clearcoat_light{device, shaders::clearcoat_light_comp(), "clearcoat light"};
  vulkan::Kernel split_paths{device, shaders::split_paths_comp(), "forks of paths"};
  vulkan::Kernel through_rays{device, shaders::through_rays_comp(), "rays through surfaces"};
  vulkan::Kernel add_behind_light{device, shaders::add_behind_light_comp(),
                                  "add light of sources behind surfaces"};
  vulkan::Kernel start_through{device, shaders::start_through_comp(), "start of what is seen"};
  vulkan::Kernel keep_behind{device, shaders::keep_behind_comp(), "keep light behind glass"};
  vulkan::Kernel keep_through{device, shaders::keep_through_comp(), "keep light through surfaces"};
  vulkan::Kernel seen_distances{device, shaders::seen_distances_comp(), "distances behind glass"};
  vulkan::Kernel add_behind{device, shaders::add_behind_comp(), "add light behind glass"};
  vulkan::Kernel show_through{device, shaders::show_through_comp(), "show light through surfaces"};
  vulkan::Kernel fog_pixels{device, shaders::fog_pixels_comp(), "fog of pixels"};
  vulkan::Kernel compose{device, shaders::compose_comp(), "compose"};
  vulkan::Kernel keep_pixels{device, shaders::keep_pixels_comp(), "keep pixels"};
  vulkan::Kernel keep_mirrored{device, shaders::keep_mirrored_comp(), "keep coats in mirrors"};
  vulkan::Kernel keep_mirrored_bases{device, shaders::keep_mirrored_bases_comp(),
                                     "keep surfaces in mirrors"};
  vulkan::Kernel shown_points{device, shaders::shown_points_comp(), "points that are shown"};
  vulkan::Kernel keep_clearcoats{device, shaders::keep_clearcoats_comp(), "keep clearcoats"};
  vulkan::Kernel add_filtered{device, shaders::add_filtered_comp(), "add filtered"};
  vulkan::Kernel luminances{device, shaders::luminances_comp(), "luminances"};
  vulkan::Kernel scale_layers{device, shaders::scale_layers_comp(), "scale layers"};
};

class FramePassesVulkan final : public FramePasses {
 public:
  explicit FramePassesVulkan(const DeviceWorld& world);

  void begin(const FrameRequest& request, RenderedFrame& frame) override;
  void rsm() override;
  void guide() override;
  void light_fog() override;
  void gbuffer(const Band& band, int sample) override;
  void motion() override;
  void direct() override;
  void rsm_direct() override;
  void indirect() override;
  void gather() override;
  void glossy() override;
  void gather_in_mirrors() override;
  void transmission() override;
  void gather_behind_glass() override;
  void rsm_upsample() override;
  void fog() override;
  void compose(float share) override;
  void denoise(float share) override;
  void read_luminances(std::vector<float>& luminances) override;
  float exposure() override;
  void refine(const FrameRequest& request, float kept) override;
  void antialias() override;
  void finish() override;

 private:
  using Buffer = vulkan::Buffer;
  using Recorder = vulkan::Recorder;
  using Record = std::function<void(Recorder&)>;
  struct Step {
    std::string name;
    Record record;
  };

  DeviceStage stage() const;
  /// Writes the scene's fog to the device, for passes that run before the froxels are lit. Returns
  /// the number of media.
  std::uint32_t upload_media();
  /// Traces the small view of reflective shadow maps into `small_`.
  void trace_small_view(int width, int height);
  /// Appends a pass, which sees the results of the passes before it.
  void add(const char* name, Record record);
  void run_steps();
  void reserve_pixels(std::size_t pixels);
  /// How many of the picture's `count` pixels from `first` on have a sample.
  std::uint32_t sampled_pixels(std::uint32_t first, std::uint32_t count) const;
  void trace_pixels(Recorder& to, const CameraRaysArguments& arguments);
  /// Makes room for the positions, normals and depths of a view's pixels.
  RsmViewOnDevice reserve_geometry(int width, int height, Buffer (&geometry)[3]);
  /// Appends a pass that writes those of `count` traced pixels, from pixel `first` on.
  void add_geometry(const char* name, const RsmViewOnDevice& view, std::uint32_t first,
                    std::uint32_t count);
  /// Makes room for `count` elements; memory that grew is uninitialised.
  template <class T>
  void reserve(std::size_t count, const char* name, Buffer& buffer) const {
    buffer.reserve(device_, count * sizeof(T), name);
  }
  void look_up(const char* name, const IrradianceField& field, const Buffer& queries,
               std::uint32_t count, CorrectionUse use, const Buffer& irradiance);
  /// Surfaces that gather light, one for each pixel of the band, and where the light goes.
  struct GatheringSurfaces {
    LitPointArray points;
    PixelSurfaceArray surfaces;
    std::uint32_t rays_per_pixel;
    bool guided;
    Vec3Array known;  ///< Irradiance from lookups; read where `excess` is there.
    Vec3Array irradiance;
    FloatArray variance;
    Vec3Array excess;  ///< Address 0: none is split off.
  };
  /// Some of them, whose light is gathered at a time.
  struct GatheredPixels {
    GatheringSurfaces all;
    std::uint32_t first, count;
    std::uint32_t rays() const { return count * all.rays_per_pixel; }
  };
  /// Makes room for the gathers of so many pixels, which have so many rays.
  void reserve_gather(std::size_t pixels, std::size_t rays);
  /// Appends passes that trace rays which gather light, and light their hits. The rays come in runs
  /// of `rays_per_index`, see HitShading::shade_hits.
  void light_gathers(const GatherBuffers& gathers, std::uint32_t count, const Buffer& first_indices,
                     std::uint32_t rays_per_index, const ShadeHitsSettings& shading);
  // Append the passes of a gather; see gather/gather.cpp
  void draw_gathers(const GatheredPixels& pixels);
  void draw_secondary_gathers(const GatheredPixels& pixels, int volumes, int depth);
  void sum_gathers(const GatheredPixels& pixels);
  /// Gathers the light of the band's surfaces.
  void gather_light(const GatheringSurfaces& surfaces);
  /// Makes room for what the shown surfaces of so many pixels gather.
  ShownGatherRecord room_to_gather(std::size_t pixels, ShownGatherBuffers& buffers) const;
  void gather_shown(ShownBaseArray bases, ShownGatherBuffers& buffers,
                    const ShownGatherRecord& kept);
  /// Lights the coats of the rows around the band, which see_around_band() has filled in, by rays;
  /// see Glossy::reflect. `sky`: see reflect_band(). Returns whether there are any rays.
  bool trace_coats(const Band& around, CoatKind kind, const Buffer& sky);
  CoatRaysArguments coat_rays_of(std::uint32_t first, std::uint32_t count, int first_row,
                                 std::uint32_t seed) const;
  bool add_further_rays(const Band& around, std::uint32_t seed, std::uint32_t ray);
  /// The rows whose rays the band's coats reflect.
  Band rows_around_band() const;
  void see_around_band(const Band& around);
  /// Computes the light of clearcoats; see reflect_clearcoats() in glossy_frame.h.
  void light_clearcoats();
  /// Looks up the field's light for the coats of the band's pixels, which lie at these addresses.
  void look_up_coats(std::uint64_t points, std::uint64_t surfaces);
  void reserve_paths(std::size_t pixels);
  void reserve_list(std::size_t paths, PathBuffers& list);
  std::uint32_t count_paths(const PathBuffers& list);
  bool follow_all(std::uint32_t first_bounce, std::uint32_t first_index, std::uint32_t salt);
  void follow_paths(std::uint32_t paths, std::uint32_t bounce, std::uint32_t first_index,
                    std::uint32_t salt);
  void reuse_coat_rays(const Band& around, const Buffer& sky, std::uint32_t keeps);
  /// kKeepsMirrored, kKeepsMirroredBases and kGathersInMirrors, where that light is filtered.
  std::uint32_t mirrored_light_kept() const;
  std::uint64_t first_of_band() const;
  void keep_mirrored_bases(Recorder& to, std::uint32_t paths, const PathBuffers& from);
  /// Adds the light of sources behind rough surfaces, see Glossy::sample_lights_behind: of pixels,
  /// or of the paths in a list.
  void sample_lights_behind(Recorder& to, const DevicePixels& seen, std::uint32_t count, uint salt,
                            const PathBuffers* paths);
  /// See pack_path_step().
  std::uint32_t path_step(std::uint32_t bounce) const;
  /// Samples of emitters at each hit of paths; 0 where nothing is drawn at random.
  std::uint32_t reflected_draws() const;
  void begin_through(std::size_t pixels);
  void start_through();
  void keep_behind(Recorder& to, std::uint32_t paths, const PathBuffers& from);
  void split_paths(const PathBuffers& from, std::uint32_t count, std::uint32_t bounce,
                   std::uint32_t first_index, std::uint32_t salt);
  void keep_through();
  void denoise_coats(const DenoiseViewOnDevice& view);
  void denoise_gathered(Recorder& to, const DenoiseViewOnDevice& view,
                        const NoisyLightOnDevice& light, Vec3Array excess, Vec3Array filtered);
  void denoise_shown(Recorder& to, DenoiseViewOnDevice view, const ShownGatherRecord& kept);
  void denoise_mirrored_bases(Recorder& to, DenoiseViewOnDevice view);
  void denoise_through(const DenoiseViewOnDevice& view, const ShownPixels& shown, float share);
  void upload_before();
  void begin_motion(std::size_t pixels);
  void finish_motion(LayeredImage& image);
  std::uint32_t emitter_draws() const;
  bool filters_coats() const;
  void keep_mirrored();
  void make_room_for_mirrors(std::size_t pixels);
  void begin_filter();
  void keep_pixels();
  /// First pixel of the band among the traced pixels.
  std::uint32_t first_traced_pixel() const;
  void read_layers(LayeredImage& image);

  const DeviceWorld& world_;
  const vulkan::Device& device_;
  FrameKernels& kernels_;
  FrameMemory memory_;
  vulkan::Timestamps timestamps_;
  Buffer shadow_rays_[2];  // of pixels, and of the hits of gathering rays
  std::vector<PixelLayers> pixel_layers_;
  GatherGuide guide_;
  RsmViewOnDevice small_;  // the small view of reflective shadow maps

  // State of the frame being rendered
  std::unique_lock<std::mutex> turn_;
  const FrameRequest* request_ = nullptr;
  RenderedFrame* frame_ = nullptr;
  std::vector<Step> steps_;
  std::vector<Layer> stage_layers_;
  Band band_;
  std::uint32_t first_pixel_ = 0, pixels_ = 0;  // of the band
  std::uint32_t sample_ = 0;
  uint ray_light_flags_ = 0;     // kinds of light from rays, see ComposeArguments::has
  const char* path_pass_ = "";   // name of the pass whose paths are traced
  std::uint32_t path_seed_ = 0;  // seed of the paths' random numbers
  bool splits_paths_ = false;    // paths split, with branches in FrameMemory::forks
  bool samples_behind_ = false;  // there may be lights behind rough surfaces to sample
  uint keeps_in_mirrors_ = 0;    // mirrored_light_kept() while coats' paths are traced
  bool keeps_behind_ = false;    // light of the first opaque surfaces behind glass is stored apart
};

}  // namespace lambent
