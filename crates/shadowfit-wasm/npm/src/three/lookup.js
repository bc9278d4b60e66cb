// The look-up by coverage: GLSL that three.js's fragment shaders include, and the uniforms that it reads.
//
// A sun of three.js has two matrices and two vectors of uniforms, in arrays that suns share. Their sizes are fixed, so
// the data of up to four windows is packed into them:
//
//   matrix 0   columns 0 to 2: an axis of the light (u, v, toward the light), and a coordinate of the origin
//              column 3: depth of the origin in each window, moved toward the light by the constant bias
//   matrix 1   column i: scale of u and v, offset of u and v, to 0..1 in window i, the finest first
//   vector 0   receiver-plane bias (texels), -1 / depth range, blend (texels), -number of windows
//   vector 1   columns of the atlas, -rows, view depth at which shadows end, 0
//
// A stock sun never has a negative number in w. The first component is greater than the second in both vectors, so a
// program that was compiled before this module was loaded finds no cascade that contains a point, and draws it lit.
//
// The rule and the formulas are the library's: see "Look up" in docs/INTEGRATION.md.

import { ShaderChunk } from 'three';

import { DISC_PER_RADIUS, FADE, MAX_WINDOWS, NO_END } from './settings.js';
import { warnOnce } from './warn.js';

/** Look-ups of the disc. Fewer show the noise of the rotation, more cost time. */
const DISC_LOOK_UPS = 16;

/** Below this cosine (89.7 degrees from the light), a surface's slope is clamped. Such surfaces receive almost no light. */
const MIN_COSINE = 0.005;

/** Step of the depths in a map with 24 bits. */
const DEPTH_STEP = 1 / 16_777_215;

const GLSL = /* glsl */`
		// Look-up by coverage. See src/three/lookup.js in the npm package "shadowfit".

		#if defined( SHADOWMAP_TYPE_PCF )

			#define SHADOWFIT_MAP sampler2DShadow

		#else

			#define SHADOWFIT_MAP sampler2D

		#endif

		struct ShadowfitPoint {
			// Position in the window, and size of the window, in texels.
			vec2 texel;
			vec2 size;
			// First texel of the window's tile in the atlas, and size of a texel in texture coordinates.
			vec2 corner;
			vec2 unit;
			// Change of the surface's depth per texel, and biased depth.
			vec2 gradient;
			float depth;
		};

		// Compares the surface with the map at a position in the window, in texels.
		float shadowfitCompare( SHADOWFIT_MAP shadowMap, ShadowfitPoint point, vec2 at ) {

			vec2 inside = clamp( at, vec2( 0.5 ), point.size - 0.5 );
			vec2 uv = ( point.corner + inside ) * point.unit;
			float depth = clamp( point.depth + dot( point.gradient, inside - point.texel ), 0.0, 1.0 );

			#ifdef USE_REVERSED_DEPTH_BUFFER

				depth = 1.0 - depth;

			#endif

			#if defined( SHADOWMAP_TYPE_PCF )

				return textureLod( shadowMap, vec3( uv, depth ), 0.0 );

			#else

				float stored = textureLod( shadowMap, uv, 0.0 ).r;

				#ifdef USE_REVERSED_DEPTH_BUFFER

					return step( stored, depth );

				#else

					return step( depth, stored );

				#endif

			#endif

		}

		#if defined( SHADOWMAP_TYPE_PCF )

			// Tent of 3 x 3 bilinear comparisons with the weights 1 2 1 along each axis, one texel apart. Along an axis they
			// weight four texels by 1-t, 2-t, 1+t and t, over 4. Two comparisons between the pairs of these texels give the
			// same sum. It reaches as far as three.js's own filter.
			float shadowfitTent( SHADOWFIT_MAP shadowMap, ShadowfitPoint point ) {

				vec2 centre = floor( point.texel - 0.5 ) + 0.5;
				vec2 t = point.texel - centre;
				vec2 w0 = 3.0 - 2.0 * t;
				vec2 w1 = 1.0 + 2.0 * t;
				vec2 p0 = centre - 1.0 + ( 2.0 - t ) / w0;
				vec2 p1 = centre + 1.0 + t / w1;

				return ( w0.x * w0.y * shadowfitCompare( shadowMap, point, p0 )
					+ w1.x * w0.y * shadowfitCompare( shadowMap, point, vec2( p1.x, p0.y ) )
					+ w0.x * w1.y * shadowfitCompare( shadowMap, point, vec2( p0.x, p1.y ) )
					+ w1.x * w1.y * shadowfitCompare( shadowMap, point, p1 ) ) / 16.0;

			}

			float shadowfitDisc( SHADOWFIT_MAP shadowMap, ShadowfitPoint point, float radius ) {

				float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
				float sum = 0.0;

				for ( int i = 0; i < ${DISC_LOOK_UPS}; i ++ ) {

					vec2 at = point.texel + vogelDiskSample( i, ${DISC_LOOK_UPS}, phi ) * radius;
					sum += shadowfitCompare( shadowMap, point, at );

				}

				return sum / ${DISC_LOOK_UPS}.0;

			}

		#endif

		float shadowfitFilter( SHADOWFIT_MAP shadowMap, ShadowfitPoint point, float radius ) {

			#if defined( SHADOWMAP_TYPE_PCF )

				if ( radius > 1.0 ) return shadowfitDisc( shadowMap, point, radius * ${DISC_PER_RADIUS}.0 );

				return shadowfitTent( shadowMap, point );

			#else

				return shadowfitCompare( shadowMap, point, point.texel );

			#endif

		}

		// Returns the share of the light that reaches the fragment, without the shadow's intensity.
		float shadowfitSunShadow( SHADOWFIT_MAP shadowMap, vec2 mapSize, float radius, mat4 axes, mat4 windows, vec4 a, vec4 b ) {

			// Position relative to the origin, along the light's axes. Only the differences to the neighbouring pixels
			// give the surface that is drawn: interpolated normals tilt away from it.

			vec3 origin = vec3( axes[ 0 ].w, axes[ 1 ].w, axes[ 2 ].w );
			vec3 light = ( vSunShadowWorldPosition.xyz - origin ) * mat3( axes );
			vec3 normal = cross( dFdx( light ), dFdy( light ) );
			float away = max( max( abs( normal.z ), ${MIN_COSINE} * length( normal ) ), 1e-36 );
			vec2 slope = - normal.xy * ( normal.z < 0.0 ? - 1.0 : 1.0 ) / away;

			int count = int( - a.w );
			vec2 grid = vec2( b.x, - b.y );
			vec2 size = mapSize / grid;

			#if defined( SHADOWMAP_TYPE_PCF )

				float reach = 1.0 + ${DISC_PER_RADIUS}.0 * max( radius, 1.0 );

			#else

				float reach = 0.5;

			#endif

			// The finest window that contains the filter's footprint, and the next one, or the finest that contains the
			// point alone.

			int first = - 1;
			int second = - 1;
			int narrow = - 1;
			float weight = 1.0;

			for ( int i = 0; i < ${MAX_WINDOWS}; i ++ ) {

				if ( i >= count ) break;

				vec2 uv = light.xy * windows[ i ].xy + windows[ i ].zw;
				vec2 sides = min( uv, 1.0 - uv ) * size;
				float free = min( sides.x, sides.y );

				if ( free >= reach ) {

					if ( first < 0 ) {

						first = i;
						weight = free - reach < a.z ? ( free - reach ) / a.z : 1.0;

					} else if ( second < 0 ) {

						second = i;

					}

				} else if ( free >= 0.0 && narrow < 0 ) {

					narrow = i;

				}

			}

			if ( first < 0 ) first = narrow;
			if ( first < 0 ) return 1.0;
			if ( second < 0 ) weight = 1.0;

			float shadow = 0.0;

			for ( int pass = 0; pass < 2; pass ++ ) {

				float share = pass == 0 ? weight : 1.0 - weight;

				if ( share <= 0.0 ) continue;

				int i = pass == 0 ? first : second;
				vec4 window = windows[ i ];
				vec2 gradient = slope * a.y / ( window.xy * size );
				float rise = a.x * ( abs( gradient.x ) + abs( gradient.y ) );
				vec2 tile = i < int( grid.x ) ? vec2( float( i ), 0.0 ) : vec2( float( i ) - grid.x, 1.0 );

				ShadowfitPoint point;
				point.texel = ( light.xy * window.xy + window.zw ) * size;
				point.size = size;
				point.corner = tile * size;
				point.unit = 1.0 / mapSize;
				point.gradient = gradient;
				point.depth = axes[ 3 ][ i ] + light.z * a.y - rise;

				shadow += share * shadowfitFilter( shadowMap, point, radius );

			}

			return mix( shadow, 1.0, smoothstep( ${1 - FADE} * b.z, b.z, vSunShadowWorldPosition.w ) );

		}

`;

/** Lines of three.js's chunk that the look-up depends on, without white space. */
const EXPECTED = [
  '#define SUN_LIGHT_CASCADES 2',
  'uniform sampler2DShadow sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];',
  'uniform mat4 sunShadowMatrix[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];',
  'uniform vec4 sunShadowCascade[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];',
  'varying vec4 vSunShadowWorldPosition;',
  'float shadowIntensity; float shadowBias; float shadowNormalBias; float shadowRadius; vec2 shadowMapSize;',
  'float interleavedGradientNoise( vec2 position )',
  'vec2 vogelDiskSample( int sampleIndex, int samplesCount, float phi )',
  'SunLightShadow sunLightShadow, int shadowIndex ) {',
];
const FUNCTION = 'float getSunShadow(';
const OFFSET = 'int cascadeOffset = shadowIndex * SUN_LIGHT_CASCADES;';
const MARK = 'shadowfitSunShadow';

const CALL = `
			if ( sunShadowCascade[ cascadeOffset ].w < 0.0 ) {

				float coverage = shadowfitSunShadow(
					shadowMap,
					sunLightShadow.shadowMapSize,
					sunLightShadow.shadowRadius,
					sunShadowMatrix[ cascadeOffset ],
					sunShadowMatrix[ cascadeOffset + 1 ],
					sunShadowCascade[ cascadeOffset ],
					sunShadowCascade[ cascadeOffset + 1 ]
				);

				return mix( 1.0, coverage, sunLightShadow.shadowIntensity );

			}
`;

/**
 * Returns three.js's chunk with the look-up, or undefined if the chunk is not the expected one.
 * @param {string} chunk
 */
export function withLookUp(chunk) {
  const bare = (text) => text.replace(/\s+/g, '');
  const text = bare(chunk);
  const once = (part) => chunk.split(part).length === 2;
  if (!once(FUNCTION) || !once(OFFSET) || EXPECTED.some((part) => !text.includes(bare(part)))) {
    return undefined;
  }
  return chunk.replace(FUNCTION, () => GLSL.trimStart() + '\t\t' + FUNCTION).replace(OFFSET, () => OFFSET + '\n' + CALL);
}

/**
 * Adds the look-up to three.js's shaders. Returns false, with one warning, if this three.js has another chunk. Programs
 * that are compiled earlier do not get the look-up, so the module calls it when it is loaded.
 */
export function installLookUp() {
  const chunk = ShaderChunk.shadowmap_pars_fragment;
  if (chunk.includes(MARK)) {
    return true;
  }
  const changed = withLookUp(chunk);
  if (changed === undefined) {
    warnOnce('chunk', 'the shader chunk "shadowmap_pars_fragment" is not the one of three.js r186 or r187. '
      + 'Suns use the stock look-up with two maps (lookUp: "stock").');
    return false;
  }
  ShaderChunk.shadowmap_pars_fragment = changed;
  return true;
}

/**
 * Writes the uniforms of a sun for the look-up by coverage.
 * @param {{ matrices: import('three').Matrix4[], vectors: import('three').Vector4[] }} uniforms
 * @param {import('./atlas.js').Atlas} atlas
 * @param {{ origin: number[], blend: number, end: number }} frame World position near the eye, width of the blend in
 * texels, and view depth at which shadows end.
 */
export function packWindows({ matrices: [axes, places], vectors: [first, second] }, atlas, { origin, blend, end }) {
  const { windows, near, range, columns, rows } = atlas;
  const [{ x, y, z }] = windows;
  // The shader subtracts this rounded origin.
  const [ox, oy, oz] = origin.map(Math.fround);
  const along = (axis, [px, py, pz]) => axis[0] * (px - ox) + axis[1] * (py - oy) + axis[2] * (pz - oz);
  // Row by row: column 3 has the depths of the windows.
  const depths = Array.from({ length: MAX_WINDOWS }, (_, index) => {
    const window = windows[index];
    return window ? (near - dot(z, [ox, oy, oz])) / range - depthBias(window, atlas) : 0;
  });
  axes.set(
    x[0], y[0], z[0], depths[0],
    x[1], y[1], z[1], depths[1],
    x[2], y[2], z[2], depths[2],
    ox, oy, oz, depths[3],
  );
  const columnsOfPlaces = windows.map(({ width, height, position }) =>
    [1 / width, 1 / height, 0.5 - along(x, position) / width, 0.5 - along(y, position) / height]);
  places.fromArray([...columnsOfPlaces.flat(), ...new Array(16).fill(0)].slice(0, 16));
  const receiverPlane = Math.max(...windows.map((window) => window.receiverPlane));
  first.set(receiverPlane, -1 / range, Math.max(blend, 1e-6), -windows.length);
  second.set(columns, -rows, Math.min(end, NO_END), 0);
}

/**
 * Returns the constant bias of a window in the atlas, in units of 0..1 over the atlas's depth range. The atlas is deeper
 * than the window, so its depths have coarser steps. Reversed depths are rounded once more.
 * @param {import('../fitter.d.ts').FittedMap} window
 * @param {{ range: number, isReversed: boolean }} atlas
 */
export function depthBias(window, { range, isReversed }) {
  const share = window.depthRange / range;
  return window.constantDepth * share + DEPTH_STEP * (1 - share + (isReversed ? 1 : 0));
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
