/** The sun with shadowfit in React Three Fiber. */

import { useMemo } from 'react';
import { Canvas, extend } from '@react-three/fiber';
import { SunLight } from 'three/addons/lights/SunLight.js';
import { ShadowfitShadow } from 'shadowfit/three';

extend({ SunLight });

function Sun(props) {
  // One shadow for the whole life of the component, since it remembers the maps of earlier frames.
  const shadow = useMemo(() => new ShadowfitShadow({ maps: 4, mapSize: 2048, distance: 100 }), []);
  return <sunLight args={[0xffffff, 3]} castShadow shadow={shadow} {...props} />;
}

/** A cube on a plane. `props` are those of the canvas. */
export function App(props) {
  return (
    <Canvas {...props} shadows camera={{ position: [6, 4, 8], fov: 45, far: 100 }}>
      <color attach="background" args={['#9fb8cc']} />
      <hemisphereLight intensity={0.8} />
      <Sun position={[2, 3, 1]} />
      <mesh castShadow receiveShadow position={[0, 1, 0]}>
        <boxGeometry args={[2, 2, 2]} />
        <meshStandardMaterial color="#d98f5f" />
      </mesh>
      <mesh receiveShadow rotation-x={-Math.PI / 2}>
        <planeGeometry args={[60, 60]} />
        <meshStandardMaterial color="#8a9a6b" />
      </mesh>
    </Canvas>
  );
}
