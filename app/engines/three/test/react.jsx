// A page in React Three Fiber. The tests bundle it.

import { Canvas } from '@react-three/fiber';
import { createRoot } from 'react-dom/client';
import { Stereo } from '../examples/react.jsx';
import { watch } from './frameworks.js';

createRoot(document.getElementById('root')).render(
  <Canvas dpr={1} camera={{ position: [0, 0.5, 3], fov: 60 }}>
    <Stereo mode="synthesized" onReady={(stereo) => watch(stereo)} />
    <ambientLight intensity={1} />
    <directionalLight position={[1, 2, 3]} />
    {[-1, 0, 1].map((x) => (
      <mesh key={x} position={[x, 0, x - 1]}>
        <boxGeometry args={[0.7, 0.7, 0.7]} />
        <meshStandardMaterial color={['tomato', 'gold', 'teal'][x + 1]} />
      </mesh>
    ))}
    <mesh position={[0, 0, -3]}><planeGeometry args={[12, 8]} /><meshStandardMaterial color="slategray" /></mesh>
  </Canvas>,
);
