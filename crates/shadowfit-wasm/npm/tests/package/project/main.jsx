import { createRoot } from 'react-dom/client';
import { App } from './App.jsx';

// The test asks the sun for its figures.
const onCreated = ({ scene }) => {
  const sun = scene.children.find((child) => child.isSunLight);
  window.shadowsOf = () => sun.shadow.report();
};
createRoot(document.getElementById('root')).render(<App onCreated={onCreated} />);
