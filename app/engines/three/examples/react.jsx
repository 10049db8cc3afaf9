// React Three Fiber: <Canvas><Stereo />...</Canvas>, with the options of StereoSynthesis.

import { useThree } from '@react-three/fiber';
import { useEffect } from 'react';
import { StereoSynthesis } from 'yoro-three';

export function Stereo({ onReady, ...options }) {
  const renderer = useThree(({ gl }) => gl);
  useEffect(() => {
    const stereo = new StereoSynthesis(renderer, options);
    const undo = stereo.install();
    onReady?.(stereo);
    return () => {
      undo();
      stereo.dispose();
    };
  }, [renderer]);
  return null;
}
