// What bodies without colours of their own look like, from both sides.
import { Color } from 'three';

export const clay = new Color(0xbfae9a);
export const back = new Color(0xd9822b);
