// viz_node/web/page/main.ts -- opens the page.
import { Page } from './page.ts';
import { exposeViz } from './viz.ts';

exposeViz(new Page());
