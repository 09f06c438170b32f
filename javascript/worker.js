// A worker of a browser.
import { serve } from './serve.js';

const answer = serve(self);
self.onmessage = ({ data }) => answer(data);
