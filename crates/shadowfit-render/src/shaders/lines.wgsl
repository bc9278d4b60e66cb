// Lines of constant width on screen, each a quad of two triangles drawn as one instance.

struct LineIn {
    @builtin(vertex_index) corner: u32,
    @location(0) start: vec3<f32>,
    @location(1) start_color: vec4<f32>,
    @location(2) end: vec3<f32>,
    @location(3) end_color: vec4<f32>,
}

struct LineOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) color: vec4<f32>,
}

const LINE_PIXELS: f32 = 2.5;
// Share of the near plane's distance at which lines are clipped, because points behind the eye cannot be
// projected.
const LINE_NEAR: f32 = 0.2;

@vertex
fn vs_line(in: LineIn) -> LineOut {
    var start = frame.clip_from_world * vec4<f32>(in.start, 1.0);
    var end = frame.clip_from_world * vec4<f32>(in.end, 1.0);
    // In an orthographic picture w is 1 everywhere.
    let line_near = select(LINE_NEAR * frame.near, 0.0, frame.parallel > 0.0);
    let from_start = (line_near - start.w) / (end.w - start.w);
    if start.w < line_near { start = mix(start, end, saturate(from_start)); }
    if end.w < line_near { end = mix(start, end, saturate(from_start)); }
    let hidden = start.w < line_near * 0.5 || end.w < line_near * 0.5;

    let along = (end.xy / end.w - start.xy / start.w) * frame.viewport;
    let direction = along * inverseSqrt(max(dot(along, along), 1e-12));
    let across = vec2<f32>(-direction.y, direction.x) * LINE_PIXELS / frame.viewport;
    let is_end = in.corner == 1u || in.corner == 4u || in.corner == 5u;
    let side = select(-1.0, 1.0, in.corner == 2u || in.corner == 3u || in.corner == 5u);
    var clip = select(start, end, is_end);
    clip = vec4<f32>(clip.xy + across * side * clip.w, clip.z, clip.w);
    clip = select(clip, vec4<f32>(2.0, 2.0, 2.0, 1.0), hidden);
    return LineOut(clip, select(in.start_color, in.end_color, is_end));
}

@fragment
fn fs_line(in: LineOut) -> @location(0) vec4<f32> {
    return in.color;
}
